#include "rheo/deformation.hpp"

#include <array>
#include <cassert>
#include <cmath>

namespace rheo {
namespace {

// The four derivatives of a linear field over a triangle.
struct Gradient {
  double xx, xy, yx, yy;  // d(field_x)/dx, d(field_x)/dy, d(field_y)/dx, d(field_y)/dy
};

Gradient gradient(const Mesh& mesh, int triangle, std::span<const double> field) {
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const double scale = 0.5 / signed_area(mesh, triangle);
  Gradient g{0.0, 0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < 3; ++k) {
    // Gradient of the shape function of corner k: the opposite side, turned by a right angle.
    const Vec2 a = mesh.points[static_cast<std::size_t>(t[(k + 1) % 3])];
    const Vec2 b = mesh.points[static_cast<std::size_t>(t[(k + 2) % 3])];
    const double dx = scale * (a.y - b.y);
    const double dy = scale * (b.x - a.x);
    const double fx = field[2 * static_cast<std::size_t>(t[k])];
    const double fy = field[2 * static_cast<std::size_t>(t[k]) + 1];
    g.xx += dx * fx;
    g.xy += dy * fx;
    g.yx += dx * fy;
    g.yy += dy * fy;
  }
  return g;
}

[[maybe_unused]] bool fits(const Mesh& mesh, std::span<const double> field) {
  return field.size() == 2 * mesh.points.size();
}

}  // namespace

void strain(const Mesh& mesh, std::span<const double> u, std::span<double> out) {
  assert(fits(mesh, u) && out.size() == 3 * mesh.triangles.size());
  for (int i = 0; i < mesh.triangle_count(); ++i) {
    const Gradient g = gradient(mesh, i, u);
    double* e = &out[3 * static_cast<std::size_t>(i)];
    e[0] = g.xx;
    e[1] = g.yy;
    e[2] = g.xy + g.yx;
  }
}

namespace {

void stress_of(const Mesh& mesh, int triangle, std::span<const double> w_lambda, std::span<const double> w_mu,
               std::span<double> out) {
  const Gradient l = gradient(mesh, triangle, w_lambda);
  const Gradient m = gradient(mesh, triangle, w_mu);
  double* s = &out[3 * static_cast<std::size_t>(triangle)];
  s[0] = l.xx + l.yy + 2.0 * m.xx;
  s[1] = l.xx + l.yy + 2.0 * m.yy;
  s[2] = m.xy + m.yx;
}

}  // namespace

void stress(const Mesh& mesh, std::span<const double> w_lambda, std::span<const double> w_mu,
            std::span<double> out) {
  assert(fits(mesh, w_lambda) && fits(mesh, w_mu) && out.size() == 3 * mesh.triangles.size());
  for (int i = 0; i < mesh.triangle_count(); ++i) stress_of(mesh, i, w_lambda, w_mu, out);
}

void stress(const Mesh& mesh, std::span<const std::int32_t> triangles, std::span<const double> w_lambda,
            std::span<const double> w_mu, std::span<double> out) {
  assert(fits(mesh, w_lambda) && fits(mesh, w_mu) && out.size() == 3 * mesh.triangles.size());
  for (const std::int32_t i : triangles) stress_of(mesh, i, w_lambda, w_mu, out);
}

LinearityReport check_linearity(const Mesh& mesh, std::span<const double> u) {
  assert(fits(mesh, u));
  LinearityReport report;
  for (int i = 0; i < mesh.triangle_count(); ++i) {
    const Gradient g = gradient(mesh, i, u);
    if ((1.0 + g.xx) * (1.0 + g.yy) - g.xy * g.yx <= 0.0) {
      if (report.inverted++ == 0) report.first_inverted = i;
    }
    // Mohr's circle: principal strains are middle +- radius.
    const double middle = 0.5 * (g.xx + g.yy);
    const double radius = std::hypot(0.5 * (g.xx - g.yy), 0.5 * (g.xy + g.yx));
    if (const double e = std::abs(middle) + radius; e > report.strain) {
      report.strain = e;
      report.most_strained = i;
    }
    if (const double angle = std::abs(std::atan2(g.yx - g.xy, 2.0 + g.xx + g.yy)); angle > report.rotation) {
      report.rotation = angle;
      report.most_rotated = i;
    }
  }
  return report;
}

}  // namespace rheo
