#include "rheo/shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "rheo/error.hpp"
#include "rheo/limits.hpp"
#include "rheo/memory_limit.hpp"

namespace rheo {
namespace {

// Refuses before any memory is asked for.
void check_memory(const std::string& what, double nodes, double memory) {
  const double need = bytes_a_shape_node * nodes;
  if (const MemoryLimit limit = memory_limit(memory); need > limit.bytes) {
    throw Error(Error::Kind::input, fmt::format("{}: {:.3g} nodes need about {} of memory, {}", what, nodes,
                                                memory_text(need), beyond(limit, "take fewer")));
  }
  if (nodes > static_cast<double>(max_shape_nodes)) {
    throw Error(Error::Kind::input, fmt::format("{}: {:.3g} nodes; at most {} million nodes are allowed",
                                                what, nodes, max_shape_nodes / 1'000'000));
  }
}

void check_length(const std::string& what, double length) {
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw Error(Error::Kind::input,
                fmt::format("{} = {}: a positive, finite number of metres is needed", what, length));
  }
  if (!of_usable_size(length)) {
    throw Error(Error::Kind::input,
                fmt::format("{} = {}: {:g} to {:g} m is allowed", what, length, smallest_size, largest_size));
  }
}

}  // namespace

Mesh rectangle(Vec2 size, int nx, int ny, Diagonal diagonal, double memory) {
  check_length("rectangle width", size.x);
  check_length("rectangle height", size.y);
  const std::string what = fmt::format("rectangle nodes = [{}, {}]", nx, ny);
  if (nx < 2 || ny < 2) throw Error(Error::Kind::input, what + ": at least 2 nodes each way are needed");
  const double count = static_cast<double>(nx) * static_cast<double>(ny);
  check_memory(what, count, memory);

  Mesh mesh;
  mesh.points.reserve(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  for (int row = 0; row < ny; ++row) {
    for (int column = 0; column < nx; ++column) {
      // Multiplied before divided: the last row and column lie exactly at the size.
      mesh.points.push_back({size.x * column / (nx - 1), size.y * row / (ny - 1)});
    }
  }
  mesh.triangles.reserve(2 * static_cast<std::size_t>(nx - 1) * static_cast<std::size_t>(ny - 1));
  for (int row = 0; row + 1 < ny; ++row) {
    for (int column = 0; column + 1 < nx; ++column) {
      const int bl = row * nx + column;
      const int br = bl + 1;
      const int tl = bl + nx;
      const int tr = tl + 1;
      const bool falling =
          diagonal == Diagonal::falling || (diagonal == Diagonal::alternating && (column + row) % 2 == 0);
      if (falling) {
        mesh.triangles.push_back({bl, br, tl});
        mesh.triangles.push_back({tr, tl, br});
      } else {
        mesh.triangles.push_back({bl, br, tr});
        mesh.triangles.push_back({bl, tr, tl});
      }
    }
  }
  auto& groups = mesh.edge_groups;
  for (int row = 0; row + 1 < ny; ++row) {
    groups["left"].push_back({(row + 1) * nx, row * nx});
    groups["right"].push_back({row * nx + nx - 1, (row + 1) * nx + nx - 1});
  }
  for (int column = 0; column + 1 < nx; ++column) {
    groups["bottom"].push_back({column, column + 1});
    groups["top"].push_back({(ny - 1) * nx + column + 1, (ny - 1) * nx + column});
  }
  prepare(mesh);
  return mesh;
}

Mesh disk(double radius, int rings, double memory) {
  check_length("disk radius", radius);
  const std::string what = fmt::format("disk rings = {}", rings);
  if (rings < 1) throw Error(Error::Kind::input, what + ": at least 1 is needed");
  const double k2 = static_cast<double>(rings) * static_cast<double>(rings);
  check_memory(what, 1.0 + 3.0 * (k2 + rings), memory);

  // Node i of ring k, counted round the ring; ring 0 is the middle.
  const auto node = [](int k, int i) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + i % (6 * k); };

  Mesh mesh;
  mesh.points.reserve(static_cast<std::size_t>(node(rings + 1, 0)));
  mesh.triangles.reserve(6 * static_cast<std::size_t>(rings) * static_cast<std::size_t>(rings));
  mesh.points.push_back({0.0, 0.0});
  for (int k = 1; k <= rings; ++k) {
    const double r = radius * k / rings;
    for (int i = 0; i < 6 * k; ++i) {
      const double angle = std::numbers::pi * i / (3.0 * k);
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    // Each sixth of the ring: k triangles on the outer circle, k - 1 on the inner one.
    for (int sixth = 0; sixth < 6; ++sixth) {
      const int inner = sixth * (k - 1);
      const int outer = sixth * k;
      for (int i = 0; i < k; ++i) {
        mesh.triangles.push_back({node(k - 1, inner + i), node(k, outer + i), node(k, outer + i + 1)});
        if (i + 1 < k) {
          mesh.triangles.push_back(
              {node(k - 1, inner + i), node(k, outer + i + 1), node(k - 1, inner + i + 1)});
        }
      }
    }
  }
  for (int i = 0; i < 6 * rings; ++i) mesh.edge_groups["rim"].push_back({node(rings, i), node(rings, i + 1)});
  prepare(mesh);
  return mesh;
}

}  // namespace rheo
