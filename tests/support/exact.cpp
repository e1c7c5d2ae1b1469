#include "support/exact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rheo/simulation.hpp"
#include "support/dense_exponential.hpp"

namespace rheo::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

bool active(const Window& w, double t) {
  return w.from <= t && t < w.until;
}

// Derivatives 0..5 of a move's key course at t, on the piece that contains `inside`.
std::array<double, 6> course(const Move& move, int axis, double t, double inside) {
  const auto component = [&](const Vec2& p) { return axis == 0 ? p.x : p.y; };
  const auto& keys = move.keys;
  std::array<double, 6> d{};
  if (inside <= keys.front().t) {
    d[0] = component(keys.front().u);
    return d;
  }
  if (inside >= keys.back().t) {
    d[0] = component(keys.back().u);
    return d;
  }
  std::size_t i = 0;
  while (keys[i + 1].t < inside) ++i;
  const double length = keys[i + 1].t - keys[i].t;
  const double s = (t - keys[i].t) / length;
  const double q0 = component(keys[i].u);
  const double q1 = component(keys[i + 1].u);
  const double v0 = component(keys[i].v);
  const double v1 = component(keys[i + 1].v);
  // Powers of s with their coefficients, from the definitions of the three profiles.
  std::array<double, 6> c{};
  if (move.profile == Profile::smooth) {
    c = {q0, 0, 0, 10 * (q1 - q0), -15 * (q1 - q0), 6 * (q1 - q0)};
  } else if (move.profile == Profile::linear) {
    c = {q0, q1 - q0, 0, 0, 0, 0};
  } else {  // Hermite basis functions 2s^3-3s^2+1, s^3-2s^2+s, -2s^3+3s^2, s^3-s^2
    c[0] = q0;
    c[1] = length * v0;
    c[2] = -3 * q0 - 2 * length * v0 + 3 * q1 - length * v1;
    c[3] = 2 * q0 + length * v0 - 2 * q1 + length * v1;
  }
  for (int k = 0; k < 6; ++k) {
    double value = 0.0;
    for (int p = k; p < 6; ++p) {
      double term = c[p] * std::pow(s, p - k);
      for (int i2 = 0; i2 < k; ++i2) term *= p - i2;
      value += term;
    }
    d[k] = value / std::pow(length, k);
  }
  return d;
}

Vec2 pressure(const Traction& traction, double t) {
  const auto& keys = traction.keys;
  if (t <= keys.front().t) return keys.front().p;
  if (t >= keys.back().t) return keys.back().p;
  std::size_t i = 0;
  while (keys[i + 1].t < t) ++i;
  const double s = (t - keys[i].t) / (keys[i + 1].t - keys[i].t);
  return {(1 - s) * keys[i].p.x + s * keys[i + 1].p.x, (1 - s) * keys[i].p.y + s * keys[i + 1].p.y};
}

}  // namespace

DenseMatrices dense_matrices(const Mesh& mesh, const Material& material) {
  const int n = mesh.node_count();
  DenseMatrices m{MatrixXd::Zero(2 * n, 2 * n), MatrixXd::Zero(2 * n, 2 * n), MatrixXd::Zero(2 * n, 2 * n)};
  Eigen::Matrix3d i_lambda, i_mu;
  i_lambda << 1, 1, 0, 1, 1, 0, 0, 0, 0;
  i_mu << 2, 0, 0, 0, 2, 0, 0, 0, 1;
  for (const Triangle& t : mesh.triangles) {
    // Shape functions N_i = alpha_i + beta_i x + gamma_i y from the inverse of the coordinates' matrix.
    Eigen::Matrix3d coordinates;
    for (int i = 0; i < 3; ++i) coordinates.row(i) << 1, mesh.points[t[i]].x, mesh.points[t[i]].y;
    const double area = 0.5 * coordinates.determinant();
    const Eigen::Matrix3d shape = coordinates.inverse();
    Eigen::Matrix<double, 3, 6> b = Eigen::Matrix<double, 3, 6>::Zero();
    for (int i = 0; i < 3; ++i) {
      b(0, 2 * i) = shape(1, i);
      b(1, 2 * i + 1) = shape(2, i);
      b(2, 2 * i) = shape(2, i);
      b(2, 2 * i + 1) = shape(1, i);
    }
    const double volume = area * mesh.thickness_at(t[0]);
    const Eigen::Matrix<double, 6, 6> jl = volume * b.transpose() * i_lambda * b;
    const Eigen::Matrix<double, 6, 6> jm = volume * b.transpose() * i_mu * b;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        m.j_lambda.block<2, 2>(2 * t[i], 2 * t[j]) += jl.block<2, 2>(2 * i, 2 * j);
        m.j_mu.block<2, 2>(2 * t[i], 2 * t[j]) += jm.block<2, 2>(2 * i, 2 * j);
        double share = i == j ? 1.0 / 6 : 1.0 / 12;
        if (material.mass == Mass::lumped) share = i == j ? 1.0 / 3 : 0.0;
        m.mass.block<2, 2>(2 * t[i], 2 * t[j]) +=
            material.density * volume * share * Eigen::Matrix2d::Identity();
      }
    }
  }
  return m;
}

std::vector<Material> materials_of(const Scene& scene) {
  std::vector<Material> materials{scene.material};
  for (const Region& region : scene.regions) materials.push_back(region.material);
  return materials;
}

std::vector<DenseMatrices> matrices_by_region(const Scene& scene) {
  std::vector<DenseMatrices> matrices;
  const std::vector<Material> materials = materials_of(scene);
  for (std::size_t r = 0; r < materials.size(); ++r) {
    Mesh part = scene.mesh;
    part.triangles.clear();
    for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e) {
      const std::size_t of =
          scene.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(scene.region_of_triangle[e]);
      if (of == r) part.triangles.push_back(scene.mesh.triangles[e]);
    }
    matrices.push_back(dense_matrices(part, materials[r]));
  }
  return matrices;
}

namespace {

MatrixXd sum_of_masses(const std::vector<DenseMatrices>& matrices) {
  MatrixXd mass = matrices.front().mass;
  for (std::size_t r = 1; r < matrices.size(); ++r) mass += matrices[r].mass;
  return mass;
}

Eigen::Index parts_of(const std::vector<Material>& materials) {
  Eigen::Index parts = 2;
  for (const Material& m : materials) parts += 2 * static_cast<Eigen::Index>(m.branch_count());
  return parts;
}

// By degree of freedom and material: the share of the area of the triangles around it.
std::vector<VectorXd> area_shares(const Scene& scene) {
  const Eigen::Index d = 2 * scene.mesh.node_count();
  std::vector<VectorXd> shares(1 + scene.regions.size(), VectorXd::Zero(d));
  for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e) {
    const std::size_t of =
        scene.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(scene.region_of_triangle[e]);
    for (const int node : scene.mesh.triangles[e])
      shares[of].segment(2 * node, 2).array() += signed_area(scene.mesh, static_cast<int>(e));
  }
  VectorXd all = VectorXd::Zero(d);
  for (const VectorXd& share : shares) all += share;
  for (VectorXd& share : shares) share = share.cwiseQuotient(all).eval();
  return shares;
}

}  // namespace

MatrixXd full_operator(const DenseMatrices& m, const Material& material, const MatrixXd& constraints,
                       double omega) {
  return full_operator(std::vector<DenseMatrices>{m}, std::vector<Material>{material}, constraints, omega);
}

MatrixXd full_operator(const std::vector<DenseMatrices>& matrices, const std::vector<Material>& materials,
                       const MatrixXd& unscaled, double omega) {
  const MatrixXd mass = sum_of_masses(matrices);
  const Eigen::Index d = mass.rows();
  const Eigen::Index c = unscaled.cols();
  // Of the masses' size, or a pivot of heavy or light bodies would pass for rounding.
  const MatrixXd constraints = mass.maxCoeff() * unscaled;
  // v' and the multipliers from [M -A; -A^T 0] (v', L) = (-J w, A^T (2 omega v + omega^2 u)).
  MatrixXd kkt = MatrixXd::Zero(d + c, d + c);
  kkt.topLeftCorner(d, d) = mass;
  kkt.topRightCorner(d, c) = -constraints;
  kkt.bottomLeftCorner(c, d) = -constraints.transpose();
  const Eigen::Index size = parts_of(materials) * d;
  MatrixXd right = MatrixXd::Zero(d + c, size);
  Eigen::Index place = 2 * d;
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const Material& material = materials[r];
    const DenseMatrices& m = matrices[r];
    for (std::size_t k = 0; k < material.branch_count(); ++k, place += 2 * d) {
      right.block(0, place, d, d) = -m.j_lambda;
      right.block(0, place + d, d, d) = -m.j_mu;
    }
    right.block(0, 0, d, d) -= material.elastic.lambda * m.j_lambda + material.elastic.mu * m.j_mu;
    right.block(0, d, d, d) -= material.viscous.lambda * m.j_lambda + material.viscous.mu * m.j_mu;
  }
  right.block(d, 0, c, d) = omega * omega * constraints.transpose();
  right.block(d, d, c, d) = 2 * omega * constraints.transpose();
  const MatrixXd solved = kkt.fullPivLu().solve(right);
  MatrixXd a = MatrixXd::Zero(size, size);
  a.block(0, d, d, d).setIdentity();
  a.block(d, 0, d, size) = solved.topRows(d);
  Eigen::Index l = 2 * d;
  for (const Material& material : materials) {
    for (std::size_t k = 0; k < material.branch_count(); ++k, l += 2 * d) {
      const MaxwellBranch b = material.branch(k);
      const Eigen::Index n = l + d;
      a.block(l, d, d, d) = b.lambda_ela * MatrixXd::Identity(d, d);
      a.block(l, l, d, d) = -b.lambda_rate() * MatrixXd::Identity(d, d);
      a.block(n, d, d, d) = b.mu_ela * MatrixXd::Identity(d, d);
      a.block(n, n, d, d) = -b.mu_rate() * MatrixXd::Identity(d, d);
    }
  }
  return a;
}

ExactSolution::ExactSolution(const Scene& scene)
    : scene_(scene),
      materials_(materials_of(scene)),
      matrices_(matrices_by_region(scene)),
      mass_(sum_of_masses(matrices_)) {}

std::vector<ExactState> ExactSolution::at(const std::vector<double>& times) const {
  const Scene& s = scene_;
  const Eigen::Index d = mass_.rows();
  const std::vector<VectorXd> shares = area_shares(s);
  std::vector<double> breaks{0.0};
  const auto add = [&](double t) {
    if (t > 0 && std::isfinite(t)) breaks.push_back(t);
  };
  for (const Fix& f : s.fixes) add(f.window.from), add(f.window.until);
  for (const Move& m : s.moves) {
    add(m.window.from), add(m.window.until);
    for (const MoveKey& key : m.keys) add(key.t);
  }
  for (const Traction& t : s.tractions) {
    add(t.window.from), add(t.window.until);
    for (const TractionKey& key : t.keys) add(key.t);
  }
  for (double t : times) add(t);
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());

  const Eigen::Index size = parts_of(materials_) * d;
  VectorXd y = VectorXd::Zero(size);
  VectorXd base = VectorXd::Zero(d);  // u at the beginning of the hold minus the key then
  std::vector<const void*> holder(d, nullptr);
  VectorXd slope_before = VectorXd::Zero(d);  // b' of a hold at the end of the piece before
  std::vector<ExactState> result;
  for (std::size_t i = 0;; ++i) {
    const double t0 = breaks[i];
    const bool last = i + 1 == breaks.size();
    const double t1 = last ? t0 + 1.0 : breaks[i + 1];
    const double inside = 0.5 * (t0 + t1);

    // Columns of A with b, b', ... at t0: held degrees of freedom, then general constraints.
    struct Row {
      VectorXd a;
      std::array<double, 6> b;
      double jump;  // what A^T v changes by at t0
    };
    std::vector<Row> rows;
    std::vector<const void*> now(d, nullptr);
    bool begins = i == 0;
    VectorXd slope_after = VectorXd::Zero(d);
    const auto hold = [&](const std::vector<int>& nodes, Axis axis, const void* who, const Move* move) {
      for (int node : nodes) {
        for (int k = 0; k < 2; ++k) {
          if (axis == (k == 0 ? Axis::y : Axis::x) || now[2 * node + k]) continue;
          const int dof = 2 * node + k;
          now[dof] = who;
          std::array<double, 6> b{};
          if (move) b = course(*move, k, t0, inside);
          // A hold that begins takes A^T v to b'. One that goes on changes it by the jump of its b' alone:
          // what violates it decays by Baumgarte's equation.
          double jump = b[1] - slope_before[dof];
          if (holder[dof] != who) {
            base[dof] = y[dof] - b[0];
            jump = b[1] - y[d + dof];
          }
          if (jump != 0.0) begins = true;
          b[0] += base[dof];
          rows.push_back({VectorXd::Unit(d, dof), b, jump});
          slope_after[dof] = move ? course(*move, k, t1, inside)[1] : 0.0;
        }
      }
    };
    for (const Fix& f : s.fixes) {
      if (active(f.window, inside)) hold(f.nodes, f.axis, &f, nullptr);
    }
    for (const Move& m : s.moves) {
      if (active(m.window, inside)) hold(m.nodes, m.axis, &m, &m);
    }
    holder = now;
    slope_before = slope_after;
    const bool eliminates = s.time.constraints == ConstraintMethod::automatic;
    const std::size_t held = rows.size();
    for (const Constraint& c : s.constraints) {
      VectorXd a = VectorXd::Zero(d);
      for (const ConstraintTerm& term : c.terms)
        a[2 * term.node + (term.axis == Axis::y)] += term.coefficient;
      rows.push_back({a, {c.value, 0, 0, 0, 0, 0}, i == 0 ? -a.dot(y.segment(d, d)) : 0.0});
    }
    const auto count = static_cast<Eigen::Index>(rows.size());
    MatrixXd a(d, count);
    for (Eigen::Index k = 0; k < count; ++k) a.col(k) = rows[k].a;

    if (begins && count > 0) {  // v+ = v + M^-1 A L, A^T (v+ - v) = jump
      VectorXd jump(count);
      for (Eigen::Index k = 0; k < count; ++k) jump[k] = rows[k].jump;
      const MatrixXd y_a = mass_.ldlt().solve(a);
      y.segment(d, d) += y_a * (a.transpose() * y_a).fullPivLu().solve(jump);
    }
    if (eliminates) {  // held exactly: no drift to correct, whatever rounding says
      for (std::size_t k = 0; k < held; ++k) {
        Eigen::Index dof = 0;
        rows[k].a.maxCoeff(&dof);
        y[dof] = rows[k].b[0];
        y[d + dof] = rows[k].b[1];
      }
    }
    for (double t : times) {
      if (t != t0) continue;
      result.push_back({t0, y.segment(0, d), y.segment(d, d), VectorXd::Zero(d), VectorXd::Zero(d)});
      Eigen::Index place = 2 * d;
      for (std::size_t r = 0; r < materials_.size(); ++r) {
        const auto v = y.segment(d, d).cwiseProduct(shares[r]);
        result.back().w_lambda += materials_[r].viscous.lambda * v;
        result.back().w_mu += materials_[r].viscous.mu * v;
        for (std::size_t k = 0; k < materials_[r].branch_count(); ++k, place += 2 * d) {
          result.back().w_lambda += y.segment(place, d).cwiseProduct(shares[r]);
          result.back().w_mu += y.segment(place + d, d).cwiseProduct(shares[r]);
        }
      }
    }
    if (last) return result;

    // Augmented state: y, then 1, s, s^2/2, ... s^5/120 with s = (t - t0) / (t1 - t0), which keeps the
    // numbers level.
    const double length = t1 - t0;
    constexpr Eigen::Index extra = 6;
    MatrixXd full = MatrixXd::Zero(size + extra, size + extra);
    full.topLeftCorner(size, size) = full_operator(matrices_, materials_, a, s.time.baumgarte);
    for (Eigen::Index k = 1; k < extra; ++k) full(size + k, size + k - 1) = 1.0 / length;
    MatrixXd kkt = MatrixXd::Zero(d + count, d + count);
    kkt.topLeftCorner(d, d) = mass_;
    const double weight = mass_.maxCoeff();  // as in full_operator
    kkt.topRightCorner(d, count) = -weight * a;
    kkt.bottomLeftCorner(count, d) = -weight * a.transpose();
    const Eigen::FullPivLU<MatrixXd> lu(kkt);
    for (Eigen::Index k = 0; k < extra; ++k) {  // k-th derivative of the forcing at t0
      VectorXd right = VectorXd::Zero(d + count);
      for (const Traction& traction : s.tractions) {
        if (!active(traction.window, inside) || k > 1) continue;
        // The limit from inside the piece: pieces are linear.
        const Vec2 p1 = pressure(traction, t1);
        const Vec2 pm = pressure(traction, inside);
        const Vec2 slope{(p1.x - pm.x) / (t1 - inside), (p1.y - pm.y) / (t1 - inside)};
        const Vec2 p0{pm.x - slope.x * (inside - t0), pm.y - slope.y * (inside - t0)};
        for (const Edge& e : traction.edges) {
          const Vec2& p = s.mesh.points[e[0]];
          const Vec2& q = s.mesh.points[e[1]];
          const double half = 0.5 * s.mesh.thickness_at(e[0]) * std::hypot(q.x - p.x, q.y - p.y);
          for (int node : e) {
            right[2 * node] += half * (k == 0 ? p0.x : slope.x);
            right[2 * node + 1] += half * (k == 0 ? p0.y : slope.y);
          }
        }
      }
      if (k == 0) {
        VectorXd g(d);
        for (Eigen::Index j = 0; j < d / 2; ++j)
          g.segment(2 * j, 2) << s.body_acceleration.x, s.body_acceleration.y;
        right.head(d) += mass_ * g;
      }
      const double omega = s.time.baumgarte;
      for (Eigen::Index j = 0; j < count; ++j) {
        const auto& b = rows[j].b;
        const auto derivative = [&](Eigen::Index order) { return order < 6 ? b[order] : 0.0; };
        right[d + j] =
            -weight * (derivative(k + 2) + 2 * omega * derivative(k + 1) + omega * omega * derivative(k));
      }
      full.block(d, size + k, d, 1) = std::pow(length, k) * lu.solve(right).head(d);
    }
    VectorXd z = VectorXd::Zero(size + extra);
    z.head(size) = y;
    z[size] = 1.0;
    // Squaring loses digits where entries of very different sizes meet: numbers of one size instead, v over a
    // frequency, w over a modulus.
    double modulus = 0.0;
    for (const Material& material : materials_) {
      modulus = std::max({modulus, material.elastic.lambda, material.elastic.mu});
      for (std::size_t k = 0; k < material.branch_count(); ++k)
        modulus = std::max({modulus, material.branch(k).lambda_ela, material.branch(k).mu_ela});
    }
    if (modulus == 0.0) modulus = 1.0;
    const double frequency = std::max(
        1.0 / length, std::sqrt(modulus * full.block(d, 2 * d, d, size - 2 * d).cwiseAbs().maxCoeff()));
    VectorXd unit = VectorXd::Ones(size + extra);
    unit.segment(d, d).setConstant(frequency);
    unit.segment(2 * d, size - 2 * d).setConstant(modulus);
    const double forcing = full.block(d, size, d, extra).cwiseAbs().maxCoeff() / (frequency * frequency);
    if (forcing > 0.0) unit.head(size) *= forcing;
    full = length * (unit.cwiseInverse().asDiagonal() * full * unit.asDiagonal());
    exponentiate(full.data(), static_cast<int>(full.rows()));
    y = unit.head(size).asDiagonal() * (full.topRows(size) * unit.cwiseInverse().cwiseProduct(z)).eval();
  }
}

double run_error(const std::vector<ExactState>& exact, const std::vector<ExactState>& run) {
  if (exact.size() != run.size()) throw std::runtime_error("run_error: different numbers of states");
  double error = 0.0;
  for (auto block : {&ExactState::u, &ExactState::v, &ExactState::w_lambda, &ExactState::w_mu}) {
    double largest = 0.0;
    double difference = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      largest = std::max(largest, (exact[i].*block).norm());
      difference = std::max(difference, (exact[i].*block - run[i].*block).norm());
    }
    if (!(difference >= 0.0)) return difference;  // NaN
    if (difference > 0.0) error = std::max(error, largest > 0.0 ? difference / largest : INFINITY);
  }
  return error;
}

std::vector<ExactState> simulate(const Scene& scene, const std::vector<double>& times) {
  Simulation simulation(scene);
  std::vector<ExactState> states;
  for (double t : times) {
    if (simulation.advance(t)) throw std::runtime_error("simulate: diverged");
    const auto vector = [](std::span<const double> x) {
      return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).eval();
    };
    states.push_back({t, vector(simulation.u()), vector(simulation.v()), vector(simulation.w_lambda()),
                      vector(simulation.w_mu())});
  }
  return states;
}

}  // namespace rheo::test
