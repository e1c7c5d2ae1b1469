#include "model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
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

SparseMatrix connection_matrix(const Mesh& mesh, const Patch& patch, Modulus modulus) {
  const std::size_t count = patch.nodes.empty() ? mesh.triangles.size() : patch.triangles.size();
  std::vector<std::int32_t> number;  // of the patch, by node of the mesh
  if (!patch.nodes.empty()) {
    number.assign(mesh.points.size(), 0);
    for (std::size_t k = 0; k < patch.nodes.size(); ++k)
      number[static_cast<std::size_t>(patch.nodes[k])] = static_cast<std::int32_t>(k);
  }
  std::vector<Triplet> entries;
  entries.reserve(count * 36);
  for (std::size_t k = 0; k < count; ++k) {
    const int e = patch.nodes.empty() ? static_cast<int>(k) : patch.triangles[k];
    Triangle t = mesh.triangles[e];
    const auto q = corners(mesh, t);
    const double scale = mesh.thickness_of(mesh.triangles[e]) / (4.0 * signed_area(mesh, e));
    if (!number.empty())
      for (int& node : t) node = number[static_cast<std::size_t>(node)];
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
  const auto size = static_cast<Eigen::Index>(patch.part);
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Largest eigenvalue of M_e^-1 K_e. B annihilates translations, so that M_e^-1 acts as 3 / (density h T)
// (lumped) or 12 / (density h T) (consistent), and the eigenvalues are those of the 3 x 3 product P = D G, G
// = B B^T: real, by the trigonometric solution of the characteristic cubic. Where that is at most `known`,
// something that is at most `known`: most triangles of a mesh need no more than a bound.
double element_eigenvalue(const Mesh& mesh, int e, const Moduli& moduli, const Material& material,
                          double known) {
  const auto q = corners(mesh, mesh.triangles[e]);
  const double la = moduli.lambda;
  const double mu = moduli.mu;
  const double largest = std::max(la, mu);
  if (largest == 0.0) return 0.0;
  // Dimensionless: tiny and huge triangles and moduli lose nothing.
  double longest = 0.0;
  for (const Corner& corner : q) longest = std::max(longest, corner.b * corner.b + corner.c * corner.c);
  longest = std::sqrt(longest);
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
  const double scale = longest / (2.0 * signed_area(mesh, e));
  const double factor = material.mass == Mass::lumped ? 3.0 : 12.0;
  const double unit = scale * scale * factor * largest / material.density;
  const double bound = (mean + 2 * spread) * unit;  // no cosine is larger than 1
  if (bound <= known || spread == 0.0) return bound;
  const double half = shifted.determinant() / (2 * spread * spread * spread);
  return (mean + 2 * spread * std::cos(std::acos(std::clamp(half, -1.0, 1.0)) / 3)) * unit;
}

std::vector<Patch> patches_of(const Mesh& mesh, const Regions& regions) {
  std::vector<Patch> patches(regions.materials.size());
  for (std::size_t r = 0; r < patches.size(); ++r) {
    Patch& patch = patches[r];
    patch.material = regions.materials[r];
    const Material& m = patch.material;
    patch.lambda = m.elastic.lambda > 0.0 || m.viscous.lambda > 0.0;
    patch.mu = m.elastic.mu > 0.0 || m.viscous.mu > 0.0;
    for (std::size_t k = 0; k < m.branch_count(); ++k) {
      patch.lambda = patch.lambda || m.branch(k).lambda_ela > 0.0;
      patch.mu = patch.mu || m.branch(k).mu_ela > 0.0;
    }
    patch.part = 2 * mesh.points.size();
  }
  if (!regions.several()) return patches;

  assert(regions.of_triangle.size() == mesh.triangles.size());
  for (std::size_t e = 0; e < mesh.triangles.size(); ++e)
    patches[static_cast<std::size_t>(regions.of_triangle[e])].triangles.push_back(static_cast<int>(e));
  std::vector<double> whole(mesh.points.size(), 0.0);  // area of a node's triangles
  for (int e = 0; e < mesh.triangle_count(); ++e)
    for (const int node : mesh.triangles[e]) whole[node] += signed_area(mesh, e);
  std::vector<double> own(mesh.points.size(), 0.0);
  for (Patch& patch : patches) {
    for (const int e : patch.triangles) {
      for (const int node : mesh.triangles[e]) {
        if (own[node] == 0.0) patch.nodes.push_back(node);
        own[node] += signed_area(mesh, e);
      }
    }
    std::sort(patch.nodes.begin(), patch.nodes.end());
    for (const std::int32_t node : patch.nodes) {
      patch.area_share.push_back(own[node] / whole[node]);
      own[node] = 0.0;
    }
    patch.part = 2 * patch.nodes.size();
  }
  return patches;
}

}  // namespace

std::int32_t Patch::number_of(std::int32_t mesh_node) const {
  if (nodes.empty()) return mesh_node;
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), mesh_node);
  assert(at != nodes.end() && *at == mesh_node);
  return static_cast<std::int32_t>(at - nodes.begin());
}

Layout::Layout(std::size_t nodes, std::span<const Patch> patches) : part(2 * nodes), end(4 * nodes) {
  const auto add = [&](Modulus modulus, std::size_t region, std::size_t number, double ela, double vis,
                       double rate) {
    if (ela == 0.0) return;
    const std::size_t size = patches[region].part;
    branches.push_back({modulus, number, ela, vis, rate, end, region, size});
    end += size;
  };
  lambda = mu = false;
  for (std::size_t r = 0; r < patches.size(); ++r) {
    const Material& material = patches[r].material;
    lambda = lambda || patches[r].lambda;
    mu = mu || patches[r].mu;
    for (std::size_t k = 0; k < material.branch_count(); ++k) {
      const MaxwellBranch b = material.branch(k);
      add(Modulus::lambda, r, k, b.lambda_ela, b.lambda_vis, b.lambda_rate());
    }
  }
  first_mu = end;
  for (std::size_t r = 0; r < patches.size(); ++r) {
    const Material& material = patches[r].material;
    for (std::size_t k = 0; k < material.branch_count(); ++k) {
      const MaxwellBranch b = material.branch(k);
      add(Modulus::mu, r, k, b.mu_ela, b.mu_vis, b.mu_rate());
    }
  }
}

Model::Model(const Mesh& mesh, const Regions& regions, Assembly assembly)
    : patches(patches_of(mesh, regions)), layout(mesh.points.size(), patches) {
  if (assembly == Assembly::edges) {
    edges = std::make_unique<EdgeForce>(std::make_shared<EdgeForm>(mesh, combined(material())),
                                        best_simd_level());
  } else if (assembly == Assembly::elements) {
    elements =
        std::make_unique<ElementForce>(std::make_shared<ElementForm>(mesh, regions), best_simd_level());
  } else {
    for (Patch& patch : patches) {
      if (patch.lambda) patch.j_lambda = connection_matrix(mesh, patch, Modulus::lambda);
      if (patch.mu) patch.j_mu = connection_matrix(mesh, patch, Modulus::mu);
    }
  }

  node_mass = Vector::Zero(mesh.node_count());
  std::vector<Triplet> entries;
  std::vector<Moduli> springs;
  for (const Patch& patch : patches) springs.push_back(patch.material.instantaneous());
  const bool consistent = patches.front().material.mass == Mass::consistent;
  double eigenvalue = 0.0;
  for (int e = 0; e < mesh.triangle_count(); ++e) {
    const std::size_t region = has_several_materials() ? static_cast<std::size_t>(regions.of_triangle[e]) : 0;
    const Material& m = patches[region].material;
    const Triangle& t = mesh.triangles[e];
    const double triangle_mass = m.density * mesh.thickness_of(t) * signed_area(mesh, e);
    for (int i = 0; i < 3; ++i) {
      node_mass[t[i]] += triangle_mass / 3;
      if (consistent) {
        for (int j = 0; j < 3; ++j) entries.emplace_back(t[i], t[j], triangle_mass / (i == j ? 6 : 12));
      }
    }
    eigenvalue = std::max(eigenvalue, element_eigenvalue(mesh, e, springs[region], m, eigenvalue));
    element_viscous = std::max(element_viscous, element_eigenvalue(mesh, e, m.viscous, m, element_viscous));
  }
  element_omega = std::sqrt(eigenvalue);
  if (consistent) {
    mass.resize(mesh.node_count(), mesh.node_count());
    mass.setFromTriplets(entries.begin(), entries.end());
  }
}

const Material& Model::material() const {
  assert(!has_several_materials());
  return patches.front().material;
}

const SparseMatrix& Model::j(Modulus modulus) const {
  assert(!has_several_materials());
  return patches.front().j(modulus);
}

std::size_t Model::branch_count() const {
  std::size_t count = 0;
  for (const Patch& patch : patches) count = std::max(count, patch.material.branch_count());
  return count;
}

bool Model::has_elastic_part() const {
  return std::any_of(patches.begin(), patches.end(), [](const Patch& patch) {
    return patch.material.elastic.lambda > 0.0 || patch.material.elastic.mu > 0.0;
  });
}

bool Model::has_viscous_part() const {
  return std::any_of(patches.begin(), patches.end(), [](const Patch& patch) {
    return patch.material.viscous.lambda > 0.0 || patch.material.viscous.mu > 0.0;
  });
}

bool Model::is_parallel() const {
  return std::any_of(patches.begin(), patches.end(),
                     [](const Patch& patch) { return !patch.material.is_one_branch(); });
}

void Model::multiply_mass(const double* x, double* out) const {
  const Eigen::Index n = node_mass.size();
  using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
  const Eigen::Map<const Nodes> in(x, n, 2);
  Eigen::Map<Nodes> result(out, n, 2);
  if (!is_lumped()) {
    result.noalias() = mass * in;
  } else {
    result = (in.array().colwise() * node_mass.array()).matrix();
  }
}

Vector Model::stiffness(const std::vector<Moduli>& moduli, const Vector& x) const {
  Vector result;
  stiffness(moduli, x, result);
  return result;
}

void Model::stiffness(const std::vector<Moduli>& moduli, const Vector& x, Vector& result) const {
  assert(moduli.size() == patches.size());
  const auto size = static_cast<std::size_t>(x.size());
  if (edges) {
    result.resize(x.size());
    edges->stiffness(moduli.front().lambda, moduli.front().mu, {x.data(), size}, {result.data(), size});
    return;
  }
  result.setZero(x.size());
  if (elements) {
    elements->stiffness(moduli, {x.data(), size}, {result.data(), size});
    return;
  }
  if (!has_several_materials()) {
    const Patch& patch = patches.front();
    const auto [lambda, mu] = moduli.front();
    if (patch.lambda && lambda != 0.0) result += lambda * (patch.j_lambda * x);
    if (patch.mu && mu != 0.0) result += mu * (patch.j_mu * x);
    return;
  }
  Vector own, force;
  for (std::size_t r = 0; r < patches.size(); ++r) {
    const Patch& patch = patches[r];
    own.resize(static_cast<Eigen::Index>(patch.part));
    force.setZero(own.size());
    patch.for_each_dof([&](std::size_t i, std::size_t j) { own[i] = x[j]; });
    if (patch.lambda && moduli[r].lambda != 0.0) force += moduli[r].lambda * (patch.j_lambda * own);
    if (patch.mu && moduli[r].mu != 0.0) force += moduli[r].mu * (patch.j_mu * own);
    patch.for_each_dof([&](std::size_t i, std::size_t j) { result[j] += force[i]; });
  }
}

ConstVectorMap sum_of_parts(const Model& model, std::size_t region, Modulus modulus, PartSum sum,
                            std::span<const double> y, Vector& memory) {
  const Layout& layout = model.layout;
  const Patch& patch = model.patches[region];
  const auto size = static_cast<Eigen::Index>(patch.part);
  const bool is_lambda = modulus == Modulus::lambda;
  const Material& material = patch.material;
  const double viscous = is_lambda ? material.viscous.lambda : material.viscous.mu;
  const double springs = is_lambda ? material.elastic.lambda : material.elastic.mu;
  const double elastic = sum == PartSum::pull ? springs : 0.0;
  const BranchPart* only = nullptr;
  int terms = (viscous > 0.0 ? 1 : 0) + (elastic > 0.0 ? 1 : 0);
  for (const BranchPart& branch : layout.branches) {
    if (branch.modulus != modulus || branch.region != region) continue;
    only = &branch;
    ++terms;
  }
  if (terms == 1 && only != nullptr) return {y.data() + only->offset, size};
  memory.setZero(size);
  for (const BranchPart& branch : layout.branches) {
    if (branch.modulus == modulus && branch.region == region)
      memory += ConstVectorMap(y.data() + branch.offset, size);
  }
  const double *u = y.data() + layout.u(), *v = y.data() + layout.v();
  if (viscous > 0.0) patch.for_each_dof([&](std::size_t i, std::size_t j) { memory[i] += viscous * v[j]; });
  if (elastic > 0.0) patch.for_each_dof([&](std::size_t i, std::size_t j) { memory[i] += elastic * u[j]; });
  return {memory.data(), memory.size()};
}

}  // namespace rheo
