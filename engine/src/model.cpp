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

SparseMatrix connection_matrix(const Mesh& mesh, Modulus modulus) {
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
        const bool is_lambda = modulus == Modulus::lambda;
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
double element_eigenvalue(const Mesh& mesh, int e, const Moduli& moduli, const Material& material) {
  const auto q = corners(mesh, mesh.triangles[e]);
  const double la = moduli.lambda;
  const double mu = moduli.mu;
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

Layout::Layout(const Mesh& mesh, const Material& material) : part(2 * mesh.points.size()) {
  const auto add = [&](Modulus modulus, std::size_t number, double ela, double vis, double rate) {
    if (ela > 0.0) branches.push_back({modulus, number, ela, vis, rate, size()});
  };
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch b = material.branch(k);
    add(Modulus::lambda, k, b.lambda_ela, b.lambda_vis, b.lambda_rate());
  }
  lambda = !branches.empty() || material.elastic.lambda > 0.0 || material.viscous.lambda > 0.0;
  first_mu = size();
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch b = material.branch(k);
    add(Modulus::mu, k, b.mu_ela, b.mu_vis, b.mu_rate());
  }
  mu = size() > first_mu || material.elastic.mu > 0.0 || material.viscous.mu > 0.0;
}

Model::Model(const Mesh& mesh, const Material& m, Assembly assembly) : material(m), layout(mesh, m) {
  if (assembly == Assembly::edges) {
    edges = std::make_unique<EdgeForce>(std::make_shared<EdgeForm>(mesh, combined(m)), best_simd_level());
  } else if (assembly == Assembly::elements) {
    elements = std::make_unique<ElementForce>(std::make_shared<ElementForm>(mesh, Regions{{m}, {}}),
                                              best_simd_level());
  } else {
    if (layout.lambda) j_lambda = connection_matrix(mesh, Modulus::lambda);
    if (layout.mu) j_mu = connection_matrix(mesh, Modulus::mu);
  }

  node_mass = Vector::Zero(mesh.node_count());
  std::vector<Triplet> entries;
  const Moduli springs = m.instantaneous();
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
    eigenvalue = std::max(eigenvalue, element_eigenvalue(mesh, e, springs, m));
    element_viscous = std::max(element_viscous, element_eigenvalue(mesh, e, m.viscous, m));
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

ConstVectorMap sum_of_parts(const Model& model, Modulus modulus, PartSum sum, std::span<const double> y,
                            Vector& memory) {
  const Layout& layout = model.layout;
  const auto part = [&](std::size_t offset) {
    return ConstVectorMap(y.data() + offset, static_cast<Eigen::Index>(layout.part));
  };
  const bool is_lambda = modulus == Modulus::lambda;
  const Material& material = model.material;
  const double viscous = is_lambda ? material.viscous.lambda : material.viscous.mu;
  const double springs = is_lambda ? material.elastic.lambda : material.elastic.mu;
  const double elastic = sum == PartSum::pull ? springs : 0.0;
  const BranchPart* only = nullptr;
  int terms = (viscous > 0.0 ? 1 : 0) + (elastic > 0.0 ? 1 : 0);
  for (const BranchPart& branch : layout.branches) {
    if (branch.modulus != modulus) continue;
    only = &branch;
    ++terms;
  }
  if (terms == 1 && only != nullptr) return part(only->offset);
  memory.setZero(static_cast<Eigen::Index>(layout.part));
  for (const BranchPart& branch : layout.branches) {
    if (branch.modulus == modulus) memory += part(branch.offset);
  }
  if (viscous > 0.0) memory += viscous * part(layout.v());
  if (elastic > 0.0) memory += elastic * part(layout.u());
  return {memory.data(), memory.size()};
}

}  // namespace rheo
