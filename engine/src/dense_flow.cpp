#include "rheo/dense_flow.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "constraints.hpp"
#include "motion.hpp"
#include "regions.hpp"
#include "schedule.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

using Matrix = Eigen::MatrixXd;
using Eigen::Index;

constexpr Index powers = 6;  // of time in the forcing: quintic courses

// Of the triangles of one material.
struct Matrices {
  Matrix j_lambda, j_mu, mass;
  Vector area;  // by degree of freedom: of those of them that touch it
};

// J_lambda = h T d d^T, J_mu = h T (2 x x^T + 2 y y^T + g g^T): d the dilatation, x, y and g the strains of a
// triangle as linear forms of its six displacements.
Matrices matrices_of(const Mesh& mesh, const Regions& regions, std::size_t region) {
  const Index size = 2 * mesh.node_count();
  const Material& material = regions.materials[region];
  Matrices m{Matrix::Zero(size, size), Matrix::Zero(size, size), Matrix::Zero(size, size),
             Vector::Zero(size)};
  using Form = Eigen::Matrix<double, 6, 1>;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (regions.several() && static_cast<std::size_t>(regions.of_triangle[k]) != region) continue;
    const Triangle& t = mesh.triangles[k];
    const double area = signed_area(mesh, static_cast<int>(k));
    for (const int node : t) m.area.segment(2 * node, 2).array() += area;
    Form x = Form::Zero(), y = Form::Zero(), g = Form::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vec2& next = mesh.points[t[(i + 1) % 3]];
      const Vec2& last = mesh.points[t[(i + 2) % 3]];
      x[2 * i] = g[2 * i + 1] = (next.y - last.y) / (2.0 * area);
      y[2 * i + 1] = g[2 * i] = (last.x - next.x) / (2.0 * area);
    }
    const double volume = area * mesh.thickness_of(t);
    const Form d = x + y;
    const Eigen::Matrix<double, 6, 6> lambda = volume * d * d.transpose();
    const Eigen::Matrix<double, 6, 6> mu =
        volume * (2.0 * x * x.transpose() + 2.0 * y * y.transpose() + g * g.transpose());
    for (int i = 0; i < 6; ++i) {
      const Index row = 2 * t[i / 2] + i % 2;
      for (int j = 0; j < 6; ++j) {
        const Index column = 2 * t[j / 2] + j % 2;
        m.j_lambda(row, column) += lambda(i, j);
        m.j_mu(row, column) += mu(i, j);
        if (i % 2 != j % 2) continue;
        const double share =
            material.mass == Mass::lumped ? (i == j ? 1.0 / 3.0 : 0.0) : (i == j ? 1.0 / 6.0 : 1.0 / 12.0);
        m.mass(row, column) += share * material.density * volume;
      }
    }
  }
  return m;
}

// A column of C: a held degree of freedom or a [[constraint]], with its b.
struct Row {
  Vector c;
  int dof = -1;
  int holder = -1;
  double value = 0.0;
  bool exact = false;  // held exactly: no Baumgarte terms
};

class Flow {
 public:
  explicit Flow(const Scene& scene)
      : scene_(scene),
        size_(2 * scene.mesh.node_count()),
        regions_(regions_of(scene)),
        matrices_(matrices_by_region(scene.mesh, regions_)),
        mass_(sum_of_masses(matrices_)),
        inverse_mass_(mass_.llt().solve(Matrix::Identity(size_, size_))),
        holders_(holders_of(scene)),
        events_(event_times(scene)),
        branches_(branches_of(regions_.materials)),
        parts_(2 + static_cast<Index>(branches_.size())),
        y_(Vector::Zero(parts_ * size_)),
        base_(Vector::Zero(size_)),
        owner_(static_cast<std::size_t>(size_), -1) {
    enter(0);
  }

  void advance(double t) {
    while (true) {
      const bool passes = !last() && (events_[index_ + 1] <= t || same_time(events_[index_ + 1], t));
      move_to(passes ? events_[index_ + 1] : t);
      if (!passes) return;
      enter(index_ + 1);
    }
  }

  // u, v and, of each modulus, the residual forces of all but the elastic part; the mean over a node's
  // materials, by their areas.
  std::vector<double> state() const {
    Vector total = Vector::Zero(4 * size_);
    total.head(2 * size_) = y_.head(2 * size_);
    Vector area = Vector::Zero(size_);
    for (const Matrices& m : matrices_) area += m.area;
    const auto add = [&](std::size_t region, Index place, double factor, const auto& x) {
      const auto share = matrices_[region].area.cwiseQuotient(area);
      total.segment(place * size_, size_) += factor * share.cwiseProduct(x);
    };
    for (std::size_t k = 0; k < branches_.size(); ++k)
      add(branches_[k].region, branches_[k].lambda ? 2 : 3, 1.0, part(2 + static_cast<Index>(k)));
    for (std::size_t r = 0; r < matrices_.size(); ++r) {
      add(r, 2, regions_.materials[r].viscous.lambda, part(1));
      add(r, 3, regions_.materials[r].viscous.mu, part(1));
    }
    return {total.data(), total.data() + total.size()};
  }

 private:
  struct Branch {
    bool lambda = true;
    double ela = 0.0, rate = 0.0;
    std::size_t region = 0;
  };
  static std::vector<Branch> branches_of(const std::vector<Material>& materials) {
    std::vector<Branch> branches;
    for (std::size_t r = 0; r < materials.size(); ++r) {
      for (std::size_t k = 0; k < materials[r].branch_count(); ++k) {
        const MaxwellBranch b = materials[r].branch(k);
        const bool first = r == 0 && k == 0;
        if (first || b.lambda_ela > 0.0) branches.push_back({true, b.lambda_ela, b.lambda_rate(), r});
        if (first || b.mu_ela > 0.0) branches.push_back({false, b.mu_ela, b.mu_rate(), r});
      }
    }
    return branches;
  }
  static std::vector<Matrices> matrices_by_region(const Mesh& mesh, const Regions& regions) {
    std::vector<Matrices> matrices;
    for (std::size_t r = 0; r < regions.materials.size(); ++r)
      matrices.push_back(matrices_of(mesh, regions, r));
    return matrices;
  }
  static Matrix sum_of_masses(const std::vector<Matrices>& matrices) {
    Matrix mass = matrices.front().mass;
    for (std::size_t r = 1; r < matrices.size(); ++r) mass += matrices[r].mass;
    return mass;
  }
  Eigen::Map<const Vector> part(Index k) const { return {y_.data() + k * size_, size_}; }

  double begin() const { return events_[index_]; }
  bool last() const { return index_ + 1 == events_.size(); }
  double end() const { return last() ? begin() + scene_.time.duration : events_[index_ + 1]; }

  double prescribed(const Row& row, double t, int derivative) const {
    if (row.holder < 0) return derivative == 0 ? row.value : 0.0;
    const double course = courses_[row.holder][row.dof % 2].derivative(t, derivative);
    return derivative == 0 ? base_[row.dof] + course : course;
  }

  // Constraints and loads of an interval; holds that begin, and velocities that jump, by an impulse.
  void enter(std::size_t i) {
    const auto before = std::move(courses_);
    index_ = i;
    now_ = begin();
    rest_ = 0.0;
    flows_.clear();
    const double inside = 0.5 * (begin() + end());
    std::vector<char> active;
    courses_.assign(holders_.size(), {});
    for (std::size_t k = 0; k < holders_.size(); ++k) {
      active.push_back(is_active(holders_[k].window, inside) ? 1 : 0);
      if (active[k] && holders_[k].move) courses_[k] = piece_at(*holders_[k].move, inside);
    }
    rows_.clear();
    std::vector<double> jumps;
    std::vector<int> owner(owner_.size(), -1);
    for (const HeldDof& h : held_dofs(holders_, active)) {
      const Polynomial& course = courses_[h.owner][h.dof % 2];
      const double slope = course.derivative(begin(), 1);
      owner[h.dof] = h.owner;
      rows_.push_back({Vector::Unit(size_, h.dof), h.dof, h.owner, 0.0,
                       scene_.time.constraints == ConstraintMethod::automatic});
      if (owner_[h.dof] != h.owner) {
        base_[h.dof] = y_[h.dof] - course.value(begin());
        jumps.push_back(slope - y_[size_ + h.dof]);
      } else {
        jumps.push_back(slope - before[h.owner][h.dof % 2].derivative(begin(), 1));
      }
    }
    owner_ = std::move(owner);
    for (const Constraint& constraint : scene_.constraints) {
      Row row{Vector::Zero(size_), -1, -1, constraint.value, false};
      for (const ConstraintTerm& term : constraint.terms)
        row.c[2 * term.node + (term.axis == Axis::y ? 1 : 0)] += term.coefficient;
      rows_.push_back(std::move(row));
      jumps.push_back(0.0);
    }
    make_operator();
    y_.segment(size_, size_) +=
        gain_ * Eigen::Map<const Vector>(jumps.data(), static_cast<Index>(jumps.size()));
    impose(begin());
  }

  // Held degrees of freedom are where they are told to be: no rounding adds up.
  void impose(double t) {
    for (const Row& row : rows_) {
      if (!row.exact) continue;
      y_[row.dof] = prescribed(row, t, 0);
      y_[size_ + row.dof] = prescribed(row, t, 1);
    }
  }

  void make_operator() {
    const auto count = static_cast<Index>(rows_.size());
    const double omega = scene_.time.baumgarte;
    Matrix c(size_, count), soft(count, size_);  // soft: C^T of the constraints that Baumgarte stabilises
    soft.setZero();
    bool any_soft = false;
    for (Index k = 0; k < count; ++k) {
      c.col(k) = rows_[k].c;
      if (rows_[k].exact) continue;
      soft.row(k) = rows_[k].c.transpose();
      any_soft = true;
    }
    const Matrix inverse_c = inverse_mass_ * c;
    gain_ = count == 0 ? Matrix(size_, 0)
                       : Matrix((c.transpose() * inverse_c).ldlt().solve(inverse_c.transpose()).transpose());
    const Matrix projected = inverse_mass_ - gain_ * inverse_c.transpose();
    std::vector<Matrix> lambda, mu;  // by region
    Matrix elastic = Matrix::Zero(size_, size_), viscous = elastic;
    for (std::size_t r = 0; r < matrices_.size(); ++r) {
      const Material& material = regions_.materials[r];
      lambda.push_back(projected * matrices_[r].j_lambda);
      mu.push_back(projected * matrices_[r].j_mu);
      elastic += material.elastic.lambda * lambda[r] + material.elastic.mu * mu[r];
      viscous += material.viscous.lambda * lambda[r] + material.viscous.mu * mu[r];
    }
    const auto j_of = [&](const Branch& b) -> const Matrix& { return (b.lambda ? lambda : mu)[b.region]; };
    // Units in which the parts of A are of one size, so that scaling and squaring loses nothing.
    const auto level = [&](double ela, const Matrix& j) {
      const double size = j.cwiseAbs().colwise().sum().maxCoeff();
      return ela > 0.0 && size > 0.0 ? std::sqrt(ela / size) : 1.0;
    };
    const double frequency =
        std::max(any_soft ? omega : 0.0, std::sqrt(elastic.cwiseAbs().colwise().sum().maxCoeff()));
    unit_ = {frequency > 0.0 ? 1.0 / frequency : 1.0, 1.0};
    for (const Branch& branch : branches_) unit_.push_back(level(branch.ela, j_of(branch)));
    const Index n = parts_ * size_;
    operator_.setZero(n + powers, n + powers);
    const auto block = [&](int row, int column) {
      return operator_.block(row * size_, column * size_, size_, size_);
    };
    const Matrix identity = Matrix::Identity(size_, size_);
    block(0, 1) = identity / unit_[0];
    block(1, 0) = -unit_[0] * (omega * omega * (gain_ * soft) + elastic);
    block(1, 1) = -2.0 * omega * (gain_ * soft) - viscous;
    for (std::size_t k = 0; k < branches_.size(); ++k) {
      const Branch& branch = branches_[k];
      const int place = static_cast<int>(k) + 2;
      block(1, place) = -unit_[k + 2] * j_of(branch);
      block(place, 1) = branch.ela / unit_[k + 2] * identity;
      block(place, place) = -branch.rate * identity;
    }

    length_ = end() - begin();
    Matrix forcing(size_, powers);
    for (int k = 0; k < powers; ++k) {
      Vector target(count);
      for (Index j = 0; j < count; ++j) {
        target[j] = prescribed(rows_[j], begin(), k + 2);
        if (!rows_[j].exact)
          target[j] += 2.0 * omega * prescribed(rows_[j], begin(), k + 1) +
                       omega * omega * prescribed(rows_[j], begin(), k);
      }
      forcing.col(k) = std::pow(length_, k) * (projected * load(k) + gain_ * target);
    }
    const double inner = operator_.cwiseAbs().colwise().sum().maxCoeff();
    const double outer = forcing.cwiseAbs().colwise().sum().maxCoeff();
    forcing_unit_ = inner > 0.0 && outer > inner ? outer / inner : 1.0;
    operator_.block(size_, n, size_, powers) = forcing / forcing_unit_;
    for (Index k = 1; k < powers; ++k) operator_(n + k, n + k - 1) = 1.0 / length_;
  }

  // The derivative of the external force at the interval's beginning.
  Vector load(int derivative) const {
    Vector f = Vector::Zero(size_);
    if (derivative == 0) {
      Vector acceleration(size_);
      for (Index i = 0; i < size_; i += 2)
        acceleration.segment(i, 2) << scene_.body_acceleration.x, scene_.body_acceleration.y;
      f = mass_ * acceleration;
    }
    const double inside = 0.5 * (begin() + end());
    for (const Traction& traction : scene_.tractions) {
      if (!is_active(traction.window, inside)) continue;
      const std::array<Polynomial, 2> course = piece_at(traction, inside);
      for (const Edge& edge : traction.edges) {
        const Vec2 &p = scene_.mesh.points[edge[0]], &q = scene_.mesh.points[edge[1]];
        const double half = 0.5 * scene_.mesh.thickness_of(edge) * std::hypot(q.x - p.x, q.y - p.y);
        for (const int node : edge)
          for (int axis = 0; axis < 2; ++axis)
            f[2 * node + axis] += half * course[axis].derivative(begin(), derivative);
      }
    }
    return f;
  }

  // exp(d A) for the steps d that occur: nearly always the distance of two outputs.
  const Matrix& flow(double d) {
    Matrix& known = flows_[d];
    if (known.size() == 0) known = (d * operator_).exp();
    return known;
  }

  void move_to(double t) {
    // Distances that differ from the common one by the rounding of t only are that one; what is lost is kept
    // in rest_, so that it never adds up.
    const double rest_before = rest_;
    double d = (t - now_) - rest_before;
    const double common = 1.0 / scene_.time.frame_rate;
    const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * t;
    if (!(d > rounding)) return;
    if (std::abs(d - common) <= rounding) {
      rest_ = common - d;
      d = common;
    } else {
      rest_ = 0.0;
    }
    Vector z(parts_ * size_ + powers);
    for (Index k = 0; k < parts_; ++k)
      z.segment(k * size_, size_) = part(k) / unit_[static_cast<std::size_t>(k)];
    const double s = (now_ + rest_before - begin()) / length_;
    double power = forcing_unit_;
    for (int k = 0; k < powers; ++k) {
      z[parts_ * size_ + k] = power;
      power *= s / (k + 1);
    }
    z = (flow(d) * z).eval();
    for (Index k = 0; k < parts_; ++k)
      y_.segment(k * size_, size_) = unit_[static_cast<std::size_t>(k)] * z.segment(k * size_, size_);
    now_ = t;
    impose(t);
  }

  const Scene& scene_;
  Index size_;  // 2n
  Regions regions_;
  std::vector<Matrices> matrices_;  // by region
  Matrix mass_;
  Matrix inverse_mass_;
  std::vector<Holder> holders_;
  std::vector<double> events_;
  std::size_t index_ = 0;
  double now_ = 0.0;
  double rest_ = 0.0;  // the state is at now_ + rest_
  std::vector<Branch>
      branches_;  // the first of both moduli, whether on or not; then those that are on, of all regions
  Index parts_;   // u, v, w of each branch
  Vector y_, base_;
  std::vector<int> owner_;  // by degree of freedom: who holds it, -1: nobody
  std::vector<Row> rows_;
  std::vector<std::array<Polynomial, 2>> courses_;
  Matrix gain_, operator_;
  std::vector<double> unit_;  // by part
  double length_ = 1.0, forcing_unit_ = 1.0;
  std::map<double, Matrix> flows_;
};

}  // namespace

std::vector<std::vector<double>> dense_flow(const Scene& scene, std::span<const double> times) {
  validate(scene);
  Flow flow(scene);
  std::vector<std::vector<double>> states;
  states.reserve(times.size());
  for (const double t : times) {
    flow.advance(t);
    states.push_back(flow.state());
  }
  return states;
}

}  // namespace rheo
