// Bodies for pictures: plain arrays as the renderer takes them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "render/mesh_picture.hpp"

namespace bodies {

struct Body {
  std::vector<double> rest;    // n x 2
  std::vector<int> triangles;  // m x 3
  std::vector<int> boundary;   // k x 2, interior on the left
  std::vector<double> positions;
  std::vector<double> scalar;
  std::vector<int> held;  // 2 node + axis
  std::vector<render::TractionArrow> arrows;

  std::size_t nodes() const { return rest.size() / 2; }
  void hold(int node) { held.insert(held.end(), {2 * node, 2 * node + 1}); }

  render::MeshFrame frame(double time = 0) const { return {positions, scalar, held, arrows, time}; }

  // Bounds of the rest and the deformed shape together.
  std::array<double, 4> bounds() const {
    std::array<double, 4> b{1e300, 1e300, -1e300, -1e300};
    for (const auto* points : {&rest, &positions}) {
      for (std::size_t i = 0; i + 1 < points->size(); i += 2) {
        b[0] = std::min(b[0], (*points)[i]);
        b[1] = std::min(b[1], (*points)[i + 1]);
        b[2] = std::max(b[2], (*points)[i]);
        b[3] = std::max(b[3], (*points)[i + 1]);
      }
    }
    return b;
  }

  render::MeshLayout layout() const {
    render::MeshLayout l;
    l.rest = rest;
    l.triangles = triangles;
    l.boundary = boundary;
    l.bounds = bounds();
    return l;
  }
};

// Directed edges that one triangle has and no neighbour has in reverse, chained one after the other.
inline std::vector<int> boundary_of(const std::vector<int>& triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) edges[{triangles[t + k], triangles[t + (k + 1) % 3]}] = 1;
  }
  std::map<int, int> next;
  for (const auto& [edge, one] : edges) {
    if (!edges.contains({edge.second, edge.first})) next[edge.first] = edge.second;
  }
  std::vector<int> boundary;
  while (!next.empty()) {
    int node = next.begin()->first;
    while (next.contains(node)) {
      const int to = next[node];
      boundary.insert(boundary.end(), {node, to});
      next.erase(node);
      node = to;
    }
  }
  return boundary;
}

// A rectangle from (0, 0), nx x ny nodes, row by row from the bottom, falling diagonals.
inline Body rectangle(double width, double height, int nx, int ny) {
  Body body;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      body.rest.push_back(width * i / (nx - 1));
      body.rest.push_back(height * j / (ny - 1));
    }
  }
  for (int j = 0; j + 1 < ny; ++j) {
    for (int i = 0; i + 1 < nx; ++i) {
      const int bl = j * nx + i, br = bl + 1, tl = bl + nx, tr = tl + 1;
      body.triangles.insert(body.triangles.end(), {bl, br, tl, tr, tl, br});
    }
  }
  body.boundary = boundary_of(body.triangles);
  body.positions = body.rest;
  body.scalar.assign(body.nodes(), 0.0);
  return body;
}

// A disk about (0, 0), 6 k nodes on ring k.
inline Body disk(double radius, int rings) {
  Body body;
  body.rest = {0, 0};
  for (int k = 1; k <= rings; ++k) {
    for (int i = 0; i < 6 * k; ++i) {
      const double angle = 2 * std::numbers::pi * i / (6 * k), r = radius * k / rings;
      body.rest.push_back(r * std::cos(angle));
      body.rest.push_back(r * std::sin(angle));
    }
  }
  const auto node = [](int k, int i) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + i % (6 * k); };
  for (int k = 1; k <= rings; ++k) {
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < k; ++i) {
        const int outer = sector * k + i, inner = sector * (k - 1) + i;
        body.triangles.insert(body.triangles.end(), {node(k, outer), node(k, outer + 1), node(k - 1, inner)});
        if (i + 1 < k) {
          body.triangles.insert(body.triangles.end(),
                                {node(k, outer + 1), node(k - 1, inner + 1), node(k - 1, inner)});
        }
      }
    }
  }
  body.boundary = boundary_of(body.triangles);
  body.positions = body.rest;
  body.scalar.assign(body.nodes(), 0.0);
  return body;
}

// Pulled to `stretch` times its length along x, narrower in the middle; the left side held, the right one
// loaded.
inline Body pulled_beam(int nx, int ny, double stretch, double traction = 10.0) {
  Body body = rectangle(1.0, 0.25, nx, ny);
  for (std::size_t i = 0; i < body.nodes(); ++i) {
    const double x = body.rest[2 * i], y = body.rest[2 * i + 1];
    const double narrow = 1 - 0.35 * std::sin(std::numbers::pi * x) * (stretch - 1) / 2;
    body.positions[2 * i] = x * (1 + (stretch - 1) * (0.6 + 0.4 * x));
    body.positions[2 * i + 1] = 0.125 + (y - 0.125) * narrow + 0.06 * x * x * (stretch - 1);
    body.scalar[i] = x * (stretch - 1) / 2 * (0.8 + 0.8 * y);
  }
  for (int j = 0; j < ny; ++j) body.hold(j * nx);
  for (std::size_t e = 0; e + 1 < body.boundary.size(); e += 2) {
    const auto a = static_cast<std::size_t>(body.boundary[e]),
               b = static_cast<std::size_t>(body.boundary[e + 1]);
    if (body.rest[2 * a] < 1 - 1e-9 || body.rest[2 * b] < 1 - 1e-9 || traction == 0) continue;
    body.arrows.push_back({{(body.positions[2 * a] + body.positions[2 * b]) / 2,
                            (body.positions[2 * a + 1] + body.positions[2 * b + 1]) / 2},
                           {traction, 0}});
  }
  return body;
}

}  // namespace bodies
