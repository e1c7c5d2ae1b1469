#include "model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rheo {
namespace {

using Triplet = Eigen::Triplet<double, int>;

struct Corner {
  double b = 0.0;
  double c = 0.0;
};

std::array<Corner, 3> corners(const Mesh& mesh, const Triangle& t) {
  std::array<Corner, 3> result;
  for (int i = 0; i < 3; ++i) {
    const Vec2& j = mesh.points[t[(i + 1) % 3]];
    const Vec2& k = mesh.points[t[(i + 2) % 3]];
    result[i] = {j.y - k.y, k.x - j.x};
  }
  return result;
}

enum class Tensor { lambda, mu };

SparseMatrix connection_matrix(const Mesh& mesh, Tensor tensor) {
  std::vector<Triplet> entries;
  entries.reserve(mesh.triangles.size() * 36);
  for (int e = 0; e < mesh.triangle_count(); ++e) {
    const Triangle& t = mesh.triangles[e];
    const auto q = corners(mesh, t);
    const double scale = mesh.thickness / (4.0 * signed_area(mesh, e));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double bb = scale * q[i].b * q[j].b;
        const double bc = scale * q[i].b * q[j].c;
        const double cb = scale * q[i].c * q[j].b;
        const double cc = scale * q[i].c * q[j].c;
        const int r = 2 * t[i];
        const int s = 2 * t[j];
        const bool is_lambda = tensor == Tensor::lambda;
        entries.emplace_back(r, s, is_lambda ? bb : 2 * bb + cc);
        entries.emplace_back(r, s + 1, is_lambda ? bc : cb);
        entries.emplace_back(r + 1, s, is_lambda ? cb : bc);
        entries.emplace_back(r + 1, s + 1, is_lambda ? cc : 2 * cc + bb);
      }
    }
  }
  SparseMatrix matrix(2 * mesh.node_count(), 2 * mesh.node_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Largest eigenvalue of M_e^-1 K_e. B annihilates translations, so that M_e^-1 acts as 3 / (density h T)
// (lumped) or 12 / (density h T) (consistent), and the eigenvalues are those of the 3 x 3 product P = D G, G
// = B B^T: real, by the trigonometric solution of the characteristic cubic.
double element_eigenvalue(const Mesh& mesh, int e, const Material& material) {
  const auto q = corners(mesh, mesh.triangles[e]);
  const double la = material.lambda_ela;
  const double mu = material.mu_ela;
  const double largest = std::max(la, mu);
  if (largest == 0.0) return 0.0;
  // Dimensionless: tiny and huge triangles and moduli lose nothing.
  double longest = 0.0;
  for (const Corner& corner : q) longest = std::max(longest, std::hypot(corner.b, corner.c));
  double bb = 0.0, bc = 0.0, cc = 0.0;
  for (const Corner& corner : q) {
    bb += corner.b * corner.b;
    bc += corner.b * corner.c;
    cc += corner.c * corner.c;
  }
  bb /= longest * longest;
  bc /= longest * longest;
  cc /= longest * longest;
  const double d1 = (la + 2 * mu) / largest, d2 = la / largest, d3 = mu / largest;
  // Rows of B: (b, 0), (0, c), (c, b) at each corner.
  Eigen::Matrix3d g, d;
  g << bb, 0, bc, 0, cc, bc, bc, bc, bb + cc;
  d << d1, d2, 0, d2, d1, 0, 0, 0, d3;
  const Eigen::Matrix3d p = d * g;
  const double mean = p.trace() / 3;
  const Eigen::Matrix3d shifted = p - mean * Eigen::Matrix3d::Identity();
  const double spread = std::sqrt(std::max(0.0, (shifted * shifted).trace() / 6));
  double top = mean;
  if (spread > 0.0) {
    const double half = shifted.determinant() / (2 * spread * spread * spread);
    top += 2 * spread * std::cos(std::acos(std::clamp(half, -1.0, 1.0)) / 3);
  }
  const double scale = longest / (2.0 * signed_area(mesh, e));
  const double factor = material.mass == Mass::lumped ? 3.0 : 12.0;
  return top * scale * scale * factor * largest / material.density;
}

}  // namespace

Model::Model(const Mesh& mesh, const Material& m, Assembly assembly) : material(m) {
  layout.part = 2 * mesh.points.size();
  layout.lambda = m.lambda_ela > 0.0;
  layout.mu = m.mu_ela > 0.0;
  if (assembly == Assembly::edges) {
    edges = std::make_unique<EdgeForce>(std::make_shared<EdgeForm>(mesh, combined(m)), best_simd_level());
  } else if (assembly == Assembly::elements) {
    elements = std::make_unique<ElementForce>(std::make_shared<ElementForm>(mesh, Regions{{m}, {}}),
                                              best_simd_level());
  } else {
    if (layout.lambda) j_lambda = connection_matrix(mesh, Tensor::lambda);
    if (layout.mu) j_mu = connection_matrix(mesh, Tensor::mu);
  }

  node_mass = Vector::Zero(mesh.node_count());
  std::vector<Triplet> entries;
  double eigenvalue = 0.0;
  for (int e = 0; e < mesh.triangle_count(); ++e) {
    const Triangle& t = mesh.triangles[e];
    const double triangle_mass = m.density * mesh.thickness * signed_area(mesh, e);
    for (int i = 0; i < 3; ++i) {
      node_mass[t[i]] += triangle_mass / 3;
      if (m.mass == Mass::consistent) {
        for (int j = 0; j < 3; ++j) entries.emplace_back(t[i], t[j], triangle_mass / (i == j ? 6 : 12));
      }
    }
    eigenvalue = std::max(eigenvalue, element_eigenvalue(mesh, e, m));
  }
  element_omega = std::sqrt(eigenvalue);
  if (m.mass == Mass::consistent) {
    mass.resize(mesh.node_count(), mesh.node_count());
    mass.setFromTriplets(entries.begin(), entries.end());
  }
}

void Model::multiply_mass(const double* x, double* out) const {
  const Eigen::Index n = node_mass.size();
  using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
  const Eigen::Map<const Nodes> in(x, n, 2);
  Eigen::Map<Nodes> result(out, n, 2);
  if (material.mass == Mass::consistent) {
    result.noalias() = mass * in;
  } else {
    result = (in.array().colwise() * node_mass.array()).matrix();
  }
}

Vector Model::stiffness(double lambda, double mu, const Vector& x) const {
  Vector result = Vector::Zero(x.size());
  if (edges) {
    const auto size = static_cast<std::size_t>(x.size());
    edges->stiffness(lambda, mu, {x.data(), size}, {result.data(), size});
    return result;
  }
  if (elements) {
    const auto size = static_cast<std::size_t>(x.size());
    elements->stiffness(lambda, mu, {x.data(), size}, {result.data(), size});
    return result;
  }
  if (layout.lambda && lambda != 0.0) result += lambda * (j_lambda * x);
  if (layout.mu && mu != 0.0) result += mu * (j_mu * x);
  return result;
}

}  // namespace rheo
