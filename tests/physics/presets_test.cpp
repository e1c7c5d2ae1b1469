// Every named model against its closed form: relaxation and oscillation of strain that is prescribed, creep,
// recovery and vibration of one triangle under a load that comes and goes; uniaxial, confined and in shear.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <functional>

#include "rheo/deformation.hpp"
#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

using Complex = std::complex<double>;
using Polynomial = std::vector<double>;  // from the constant on

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

Polynomial sum(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
  return a;
}

Polynomial derivative(const Polynomial& a) {
  Polynomial d;
  for (std::size_t i = 1; i < a.size(); ++i) d.push_back(static_cast<double>(i) * a[i]);
  return d;
}

template <class T>
T value(const Polynomial& a, T x) {
  T v = 0.0;
  for (std::size_t i = a.size(); i-- > 0;) v = v * x + a[i];
  return v;
}

std::vector<Complex> roots(const Polynomial& a) {
  const auto n = static_cast<Eigen::Index>(a.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(i, n - 1) = -a[static_cast<std::size_t>(i)] / a.back();
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  std::vector<Complex> found;
  const Polynomial slope = derivative(a);
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(companion, false).eigenvalues();
  for (Complex z : values) {
    for (int newton = 0; newton < 3; ++newton) z -= value(a, z) / value(slope, z);
    found.push_back(z);
  }
  return found;
}

// q(t) of q'' + response * q' = 1 from rest, * the convolution: the inverse of Q(s) = 1 / (s (s^2 + s
// R(s))), s R(s) = elastic + viscous s + sum of ela s / (s + rate), by partial fractions N / (s D).
class StepResponse {
 public:
  StepResponse(Polynomial numerator, Polynomial denominator)
      : numerator_(std::move(numerator)), denominator_(std::move(denominator)) {
    flows_ = denominator_.front() == 0.0;
    if (flows_) denominator_.erase(denominator_.begin());
    poles_ = roots(denominator_);
  }

  static StepResponse of(const Response& response) {
    Polynomial all{1.0}, rest{0.0};
    for (const auto& [ela, rate] : response.branches) {
      rest = sum(product(rest, {rate, 1.0}), product(all, {0.0, ela}));
      all = product(all, {rate, 1.0});
    }
    return {all, sum(product(all, {response.elastic, response.viscous, 1.0}), rest)};
  }

  double operator()(double t) const {
    if (t <= 0.0) return 0.0;
    const double n0 = numerator_[0], d0 = denominator_[0];
    const double n1 = numerator_.size() > 1 ? numerator_[1] : 0.0;
    const double d1 = denominator_.size() > 1 ? denominator_[1] : 0.0;
    Complex q = flows_ ? n0 / d0 * t + (n1 * d0 - n0 * d1) / (d0 * d0) : n0 / d0;
    const Polynomial slope = derivative(denominator_);
    for (const Complex p : poles_) {
      const Complex residue = value(numerator_, p) / (p * value(slope, p));
      q += (flows_ ? residue / p : residue) * std::exp(p * t);
    }
    return q.real();
  }

 private:
  Polynomial numerator_, denominator_;
  bool flows_ = false;
  std::vector<Complex> poles_;
};

// Stress of one modulus under unit strain rate from t = 0 on.
double ramp(const Response& response, double t) {
  if (t <= 0.0) return 0.0;
  double stress = response.elastic * t + response.viscous;
  for (const auto& [ela, rate] : response.branches) stress += ela / rate * -std::expm1(-rate * t);
  return stress;
}

enum class State { uniaxial, confined, shear };
const char* name_of(State state) {
  return state == State::uniaxial ? "uniaxial" : state == State::confined ? "confined" : "shear";
}

// Uniaxial: lambda is a multiple of mu at all times, so that the lateral contraction is a multiple of the
// strain; else lambda relaxes 1.7 times as fast.
constexpr double ratio = 1.5;
Response lambda_of(const Response& mu, State state) {
  return mu.scaled(ratio, state == State::uniaxial ? 1.0 : 1.7);
}

struct Kind {
  Preset preset;
  State state;
  friend void PrintTo(const Kind& kind, std::ostream* out) {
    *out << kind.preset.name << " " << name_of(kind.state);
  }
};
std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const Preset& preset : presets())
    for (const State state : {State::uniaxial, State::confined, State::shear}) all.push_back({preset, state});
  return all;
}

class Models : public testing::TestWithParam<Kind> {};

using ErrorOf = std::function<double(const Scene&)>;

// Small beside the fastest rate, so that the leading term rules, and outputs and events are whole steps
// apart.
double first_step(const Preset& preset) {
  return preset.name == "whole" || preset.name == "plastic" ? 0.00125 : 0.005;
}

// With the exponential integrator nearly exact; with RK4 of order 4 over two halvings, unless it is exact.
void expect_closed_form(Scene scene, double first_step, const ErrorOf& error_of) {
  scene.time.integrator = IntegratorKind::exponential;
  scene.time.tolerance = 1e-12;
  EXPECT_LT(error_of(scene), 1e-8);
  scene.time.integrator = IntegratorKind::implicit;
  scene.time.step = first_step;  // order 8
  EXPECT_LT(error_of(scene), 1e-8);
  scene.time.integrator = IntegratorKind::rk4;
  std::vector<double> errors;
  for (int halving = 0; halving <= 2; ++halving) {
    scene.time.step = first_step / std::exp2(halving);
    errors.push_back(error_of(scene));
  }
  if (errors.front() < 1e-12) return;
  EXPECT_NEAR(std::log2(errors.front() / errors.back()) / 2, 4.0, 0.1) << errors.front() << " " << errors[1];
}

// Strain goes up, stays, and swings between both signs; all of a body's nodes are told where to be.
TEST_P(Models, RelaxationAndOscillation) {
  const Kind& kind = GetParam();
  const Response mu = kind.preset.mu, lambda = lambda_of(mu, kind.state);
  Scene scene;
  scene.mesh = rectangle({2.0, 1.0}, 2, 2);
  scene.material = material_of(lambda, mu);
  // Unit strain of each state: e_x, e_y, gamma.
  const std::array<double, 3> unit = kind.state == State::uniaxial
                                         ? std::array{-ratio / (ratio + 2), 1.0, 0.0}
                                     : kind.state == State::confined ? std::array{0.0, 1.0, 0.0}
                                                                     : std::array{0.0, 0.0, 1.0};
  const std::vector<std::pair<double, double>> course{{0.0, 0.0}, {0.1, 0.02},  {0.6, 0.02}, {0.7, -0.01},
                                                      {0.9, 0.0}, {1.1, -0.02}, {1.3, 0.01}, {1.5, 0.0}};
  for (int node = 0; node < scene.mesh.node_count(); ++node) {
    Move move{{node}, Axis::both, {}, {}, Profile::linear, "told"};
    const Vec2 x = scene.mesh.points[node];
    for (const auto& [t, e] : course)
      move.keys.push_back({t, {e * (unit[0] * x.x + unit[2] * x.y), e * unit[1] * x.y}, {}});
    scene.moves.push_back(move);
  }
  scene.time.duration = 2.0;
  scene.time.frame_rate = 20.0;
  const auto error_of = [&](const Scene& s) {
    Simulation simulation(s);
    double worst = 0.0, largest = 0.0;
    std::vector<double> sigma(3 * s.mesh.triangles.size());
    for (int k = 1; k <= 40; ++k) {
      const double t = k / 20.0;
      EXPECT_FALSE(simulation.advance(t));
      stress(s.mesh, simulation.pull_lambda(), simulation.pull_mu(), sigma);
      double l = 0.0, m = 0.0;
      for (std::size_t i = 0; i + 1 < course.size(); ++i) {
        const double rate =
            (course[i + 1].second - course[i].second) / (course[i + 1].first - course[i].first);
        // Just after a key the viscous stress is that of the piece that begins.
        const auto response = [&](const Response& r) {
          const auto since = [&](double from) {
            return t >= from - 1e-12 ? ramp(r, std::max(t - from, 1e-300)) : 0.0;
          };
          return rate * (since(course[i].first) - since(course[i + 1].first));
        };
        l += response(lambda);
        m += response(mu);
      }
      const double trace = unit[0] + unit[1];
      const std::array<double, 3> expected{l * trace + 2 * m * unit[0], l * trace + 2 * m * unit[1],
                                           m * unit[2]};
      for (std::size_t i = 0; i < sigma.size(); ++i) {
        worst = std::max(worst, std::abs(sigma[i] - expected[i % 3]));
        largest = std::max(largest, std::abs(expected[i % 3]));
      }
      if (kind.state == State::uniaxial) {
        EXPECT_NEAR(expected[0], 0.0, 1e-12 * largest);
      }
    }
    return worst / largest;
  };
  expect_closed_form(scene, first_step(kind.preset), error_of);
}

// One triangle under a load from 0 to 1.25 s, then free: with its mass, so that it also vibrates.
TEST_P(Models, CreepRecoveryAndVibration) {
  const Kind& kind = GetParam();
  const Response mu = kind.preset.mu, lambda = lambda_of(mu, kind.state);
  constexpr double until = 1.25, height = 0.8;
  Scene scene;
  scene.mesh.points = {{0.0, 0.0}, {1.0, 0.0}, {0.5, height}};
  scene.mesh.triangles = {{0, 1, 2}};
  prepare(scene.mesh);
  scene.material = material_of(lambda, mu, 0.4);
  const double area = 0.5 * height, mass = 0.4 * area / 3;
  const Vec2 pressure = kind.state == State::shear ? Vec2{0.03, 0.0} : Vec2{0.0, 0.03};
  scene.tractions.push_back({{{1, 2}, {2, 0}}, {{0.0, pressure}}, {0.0, until}, "load"});
  const double force = std::hypot(0.5, height) * 0.03;  // half of either edge's
  const double grip = 1.0 / (4 * area);                 // h c^2 / (4 T) with c = 1
  std::vector<std::pair<double, StepResponse>> modes;   // weight and response
  if (kind.state == State::uniaxial) {
    scene.fixes.push_back({{0, 1}, Axis::y, {}, "base"});
    scene.fixes.push_back({{2}, Axis::x, {}, "apex"});
    // x of node 1 (node 0 the opposite) and y of node 2: e_x = 2 x, e_y = y / height.
    Eigen::Matrix2d strain, form, inertia;
    strain << 2.0, 0.0, 0.0, 1.0 / height;
    form << ratio + 2, ratio, ratio, ratio + 2;
    inertia << 2 * mass, 0.0, 0.0, mass;
    const Eigen::Matrix2d stiffness = area * strain.transpose() * form * strain;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solved(stiffness, inertia);
    for (int i = 0; i < 2; ++i) {
      const double part = solved.eigenvectors()(1, i);
      modes.emplace_back(part * part * force, StepResponse::of(mu.scaled(solved.eigenvalues()[i])));
    }
  } else {
    scene.fixes.push_back({{0, 1}, Axis::both, {}, "base"});
    scene.fixes.push_back({{2}, kind.state == State::shear ? Axis::y : Axis::x, {}, "apex"});
    const Response whole = kind.state == State::shear ? mu : lambda.beside(mu.scaled(2.0));
    modes.emplace_back(force / mass, StepResponse::of(whole.scaled(grip / mass)));
  }
  scene.time.duration = 3.0;
  scene.time.frame_rate = 20.0;
  const std::size_t dof = kind.state == State::shear ? 4 : 5;
  const auto error_of = [&](const Scene& s) {
    Simulation simulation(s);
    double worst = 0.0, largest = 0.0;
    for (int k = 1; k <= 60; ++k) {
      const double t = k / 20.0;
      EXPECT_FALSE(simulation.advance(t));
      double expected = 0.0;
      for (const auto& [weight, response] : modes) expected += weight * (response(t) - response(t - until));
      worst = std::max(worst, std::abs(simulation.u()[dof] - expected));
      largest = std::max(largest, std::abs(expected));
    }
    return worst / largest;
  };
  expect_closed_form(scene, first_step(kind.preset), error_of);
}

INSTANTIATE_TEST_SUITE_P(All, Models, testing::ValuesIn(kinds()),
                         [](const auto& c) { return c.param.preset.name + "_" + name_of(c.param.state); });

// In series as Burgers wrote it, force over displacement s / (s/e1 + 1/n1 + s/(e2 + n2 s)).
TEST(Model, TwoBranchesInParallelAreBurgersSeries) {
  const Burgers b;
  const Polynomial top = product({0.0, b.n1, b.n1 * b.n2 / b.e2}, {1.0});
  const Polynomial bottom{1.0, b.n1 / b.e1 + b.n1 / b.e2 + b.n2 / b.e2, b.n1 * b.n2 / (b.e1 * b.e2)};
  const StepResponse series(bottom, sum(product(bottom, {0.0, 0.0, 1.0}), top));
  const StepResponse parallel = StepResponse::of(b.parallel());
  for (double t = 0.0; t < 5.0; t += 0.1) EXPECT_NEAR(parallel(t), series(t), 1e-12) << t;
  // Without mass the series' creep: t / n1 + 1 / e1 + (1 - exp(-e2 t / n2)) / e2, late and slow.
  const Response r = b.parallel();
  double viscosity = 0.0, glassy = 0.0;
  for (const auto& [ela, rate] : r.branches) viscosity += ela / rate, glassy += ela;
  EXPECT_NEAR(viscosity, b.n1, 1e-12);
  EXPECT_NEAR(glassy, b.e1, 1e-12);
}

// What is left of a body without elasticity after its load: all, of an elastic one nothing.
TEST(Model, PlasticDeformationStaysAndElasticDoesNot) {
  for (const Preset& preset : presets()) {
    if (preset.name == "elastic") continue;  // vibrates for ever
    Scene scene;
    scene.mesh = rectangle({1.0, 0.5}, 4, 3);
    scene.material = material_of(preset.mu.scaled(ratio), preset.mu, 0.2);
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
    scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0.0, {0.3, 0.0}}}, {0.0, 1.0}, "pull"});
    scene.time.duration = 60.0;
    scene.time.frame_rate = 1.0;
    scene.time.integrator = IntegratorKind::exponential;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(1.0));
    const double pulled = simulation.u()[2 * 3];
    double released = 0.0;
    for (int k = 2; k <= 60; ++k) ASSERT_FALSE(simulation.advance(k));
    released = simulation.u()[2 * 3];
    EXPECT_GT(pulled, 0.01) << preset.name;
    if (preset.mu.elastic > 0.0) {
      EXPECT_LT(std::abs(released), 1e-3 * pulled) << preset.name;
    } else {
      EXPECT_GT(released, 0.2 * pulled) << preset.name;
    }
    if (preset.name == "plastic") {
      EXPECT_GT(released, pulled) << "it flows on until its mass is braked";
    }
  }
}

}  // namespace
}  // namespace rheo::test
