#include "stability/runs/outer_limit.hpp"

#include <Spectra/GenEigsSolver.h>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "rheo/stability.hpp"
#include "support/exact.hpp"

namespace rheo::test {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Strains of one rate, and of the dashpots with rate < 0.
struct Rows {
  double rate = 0.0;
  std::vector<Eigen::Triplet<double>> entries;
  int count = 0;
};

class EnergyOperator {
 public:
  using Scalar = double;

  explicit EnergyOperator(const Scene& scene) {
    const Mesh& mesh = scene.mesh;
    const auto n = 2 * static_cast<std::size_t>(mesh.node_count());
    std::vector<char> held(n, 0);
    for (const Fix& fix : scene.fixes)
      for (const int node : fix.nodes)
        for (int k = 0; k < 2; ++k)
          if (fix.axis != (k == 0 ? Axis::y : Axis::x)) held[2 * static_cast<std::size_t>(node) + k] = 1;
    std::vector<double> mass(n, 0.0);
    const auto region_of = [&](std::size_t t) {
      return scene.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(scene.region_of_triangle[t]);
    };
    const auto corner = [&](std::size_t t, std::size_t k) {
      return static_cast<std::size_t>(mesh.triangles[t][k % 3]);
    };
    const auto doubled_area = [&](std::size_t t) {
      const Vec2 a = mesh.points[corner(t, 0)], b = mesh.points[corner(t, 1)], c = mesh.points[corner(t, 2)];
      return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const double third = doubled_area(t) / 6 * mesh.thickness * material_of(scene, region_of(t)).density;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 2; ++axis) mass[2 * corner(t, k) + axis] += third;
    }
    place_.assign(n, -1);
    for (std::size_t i = 0; i < n; ++i)
      if (!held[i]) place_[i] = free_++;

    std::vector<Rows> springs;
    Rows dashpots{-1.0, {}, 0};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const double doubled = doubled_area(t);
      const double size = std::sqrt(doubled / 2 * mesh.thickness);
      // Rows of (e_x + e_y) for lambda and of sqrt(2) e_x, sqrt(2) e_y, g for mu, times the root of a
      // modulus.
      const auto add = [&](Rows& rows, double modulus, bool is_lambda) {
        const double factor = std::sqrt(modulus) * size;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec2 p = mesh.points[corner(t, k + 1)], q = mesh.points[corner(t, k + 2)];
          const std::array<double, 2> d{(p.y - q.y) / doubled, (q.x - p.x) / doubled};
          const auto entry = [&](int row, std::size_t axis, double value) {
            const std::size_t dof = 2 * corner(t, k) + axis;
            if (place_[dof] >= 0)
              rows.entries.emplace_back(rows.count + row, place_[dof], factor * value / std::sqrt(mass[dof]));
          };
          for (std::size_t axis = 0; axis < 2; ++axis) {
            if (is_lambda) {
              entry(0, axis, d[axis]);
            } else {
              entry(static_cast<int>(axis), axis, std::sqrt(2.0) * d[axis]);
              entry(2, axis, d[1 - axis]);
            }
          }
        }
        rows.count += is_lambda ? 1 : 3;
      };
      const Material& material = material_of(scene, region_of(t));
      for (const Relaxation& each : relaxations_of(material)) {
        auto rows = std::ranges::find(springs, each.rate, &Rows::rate);
        if (rows == springs.end()) rows = springs.insert(springs.end(), Rows{each.rate, {}, 0});
        if (each.moduli.lambda > 0.0) add(*rows, each.moduli.lambda, true);
        if (each.moduli.mu > 0.0) add(*rows, each.moduli.mu, false);
      }
      if (material.viscous.lambda > 0.0) add(dashpots, material.viscous.lambda, true);
      if (material.viscous.mu > 0.0) add(dashpots, material.viscous.mu, false);
    }
    const auto matrix = [&](const Rows& rows) {
      Sparse c(rows.count, free_);
      c.setFromTriplets(rows.entries.begin(), rows.entries.end());
      return c;
    };
    dashpots_ = matrix(dashpots);
    size_ = free_;
    for (const Rows& rows : springs) {
      springs_.push_back(matrix(rows));
      rates_.push_back(rows.rate);
      size_ += rows.count;
    }
  }

  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  const std::vector<double>& rates() const { return rates_; }

  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> from(in, size_);
    Eigen::Map<Eigen::VectorXd> to(out, size_);
    const Eigen::VectorXd x = from.head(free_);
    const Eigen::VectorXd strains = dashpots_ * x;
    Eigen::VectorXd rate = -(dashpots_.transpose() * strains);
    Eigen::Index at = free_;
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const auto z = from.segment(at, springs_[k].rows());
      rate -= springs_[k].transpose() * z;
      to.segment(at, springs_[k].rows()) = springs_[k] * x - rates_[k] * z;
      at += springs_[k].rows();
    }
    to.head(free_) = rate;
  }

 private:
  std::vector<Eigen::Index> place_;
  Eigen::Index free_ = 0, size_ = 0;
  Sparse dashpots_;
  std::vector<Sparse> springs_;
  std::vector<double> rates_;
};

}  // namespace

OuterLimit outer_rk4_limit(const Scene& scene) {
  constexpr double reach = 0.87;
  const EnergyOperator op(scene);
  OuterLimit result;
  for (const Eigen::Index wanted : {40, 80}) {
    Spectra::GenEigsSolver<EnergyOperator> solver(const_cast<EnergyOperator&>(op), wanted,
                                                  std::min(op.rows(), 5 * wanted / 2));
    solver.init();
    const auto found = solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-10);
    if (solver.info() != Spectra::CompInfo::Successful) return result;
    const Eigen::VectorXcd values = solver.eigenvalues();
    result = {std::numeric_limits<double>::infinity(), static_cast<int>(found), false};
    for (const double rate : op.rates())
      if (rate > 0.0) result.step = std::min(result.step, stable_step_of(-rate, IntegratorKind::rk4));
    const double largest = values.cwiseAbs().maxCoeff();
    for (const std::complex<double> s : values)
      result.step = std::min(result.step, stable_step_of({std::min(s.real() + 1e-9 * largest, 0.0), s.imag()},
                                                         IntegratorKind::rk4));
    result.complete = values.cwiseAbs().minCoeff() < reach * largest;
    if (result.complete) break;
  }
  return result;
}

}  // namespace rheo::test
