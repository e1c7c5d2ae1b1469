// What a careful user would otherwise take for this model: SUNDIALS ARKODE (explicit Runge-Kutta) on the same
// equations, mesh and state as step_bench.cpp, with two Eigen row-major products and lumped mass as its
// right-hand side.
//
//   peer/rk4/<triangles>             the classic method, fixed steps
//   peer/dormand_prince/<triangles>  adaptive, relative tolerance 1e-6
//
// Counters: time a triangle and step; evaluations a step; for RK4 on the smaller meshes its error and that of
// the engine's RK4 after the same steps from the same state, and the order found from half the step.
// Label: the hash of the state after the first, untimed steps.
//
// SUNDIALS 6.4.1 takes the last stage for y' at the step's end whenever its node is 1. With the classic table
// that gives three evaluations a step and a wrong solution; a fifth stage of weight 0 at the new state itself
// makes the assumption true, at four evaluations a step.

#include <arkode/arkode_erkstep.h>
#include <benchmark/benchmark.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "bench/counters.hpp"
#include "bench/step_case.hpp"
#include "kernels/edge_body.hpp"
#include "rheo/integrator.hpp"

namespace {

using bench::Case;
using bench::case_of;
using rheo::Vector;
using VectorView = Eigen::Map<Vector>;

constexpr int hashed_steps = 8;

void require(bool fine, const char* what) {
  if (fine) return;
  std::fprintf(stderr, "peer_bench: SUNDIALS refuses: %s\n", what);
  std::exit(1);
}

struct Equations {
  explicit Equations(const Case& one) : c(one) {
    const auto part = static_cast<Eigen::Index>(c.model->layout.part);
    force.setZero(part);
    inverse_mass.resize(part);
    for (Eigen::Index i = 0; i < part; ++i) inverse_mass[i] = 1.0 / c.model->node_mass[i / 2];
    for (const rheo::HeldDof& h : c.interval.eliminated) inverse_mass[h.dof] = 0.0;
  }

  const Case& c;
  Vector inverse_mass, force;
};

int rate(realtype, N_Vector y, N_Vector out, void* data) {
  auto& equations = *static_cast<Equations*>(data);
  const rheo::Model& m = *equations.c.model;
  const auto part = static_cast<Eigen::Index>(m.layout.part);
  const VectorView x(N_VGetArrayPointer(y), 4 * part);
  VectorView r(N_VGetArrayPointer(out), 4 * part);
  equations.force.noalias() = m.j(rheo::Modulus::lambda) * x.segment(2 * part, part);
  equations.force.noalias() += m.j(rheo::Modulus::mu) * x.segment(3 * part, part);
  r.segment(0, part) = x.segment(part, part);
  r.segment(part, part) = equations.inverse_mass.cwiseProduct(equations.c.interval.force - equations.force);
  r.segment(2 * part, part) = m.material().lambda_ela * x.segment(part, part) -
                              m.material().lambda_rate() * x.segment(2 * part, part);
  r.segment(3 * part, part) =
      m.material().mu_ela * x.segment(part, part) - m.material().mu_rate() * x.segment(3 * part, part);
  return 0;
}

class Peer {
 public:
  explicit Peer(const Case& c) : equations_(c) {
    require(SUNContext_Create(nullptr, &context_) == 0, "a context");
    y_ = N_VNew_Serial(static_cast<sunindextype>(c.y.size()), context_);
    std::copy(c.y.begin(), c.y.end(), N_VGetArrayPointer(y_));
    memory_ = ERKStepCreate(rate, 0.0, y_, context_);
    require(memory_ != nullptr, "ERKStepCreate");
    require(ERKStepSetUserData(memory_, &equations_) == 0, "user data");
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() {
    ERKStepFree(&memory_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  void fix_rk4(double step) {
    double c[5] = {0.0, 0.5, 0.5, 1.0, 1.0};
    double b[5] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6, 0.0};
    double a[25] = {};
    a[5] = a[11] = 0.5;
    a[17] = 1.0;
    std::copy(b, b + 4, a + 20);
    ARKodeButcherTable table = ARKodeButcherTable_Create(5, 4, 0, c, a, b, nullptr);
    require(ERKStepSetTable(memory_, table) == 0, "the table");
    ARKodeButcherTable_Free(table);
    require(ERKStepSetFixedStep(memory_, step) == 0, "a fixed step");
  }

  void adapt(double relative, double absolute) {
    require(ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5) == 0, "Dormand and Prince's table");
    require(ERKStepSStolerances(memory_, relative, absolute) == 0, "tolerances");
  }

  void step() {
    constexpr double far = 1e9;  // one step towards it
    double reached = 0.0;
    require(ERKStepEvolve(memory_, far, y_, &reached, ARK_ONE_STEP) >= 0, "a step");
  }

  double evaluations_per_step() const {
    long evaluations = 0, steps = 0;
    ERKStepGetNumRhsEvals(memory_, &evaluations);
    ERKStepGetNumSteps(memory_, &steps);
    return static_cast<double>(evaluations) / static_cast<double>(std::max(steps, 1L));
  }
  double last_step() const {
    double h = 0.0;
    ERKStepGetLastStep(memory_, &h);
    return h;
  }

  bench::StateHash hash() const {
    return bench::StateHash().add({N_VGetArrayPointer(y_), static_cast<std::size_t>(N_VGetLength(y_))});
  }
  Vector state() const { return Eigen::Map<const Vector>(N_VGetArrayPointer(y_), N_VGetLength(y_)); }

 private:
  SUNContext context_ = nullptr;
  Equations equations_;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
};

Vector peer_after(const Case& c, double h, int steps) {
  Peer peer(c);
  peer.fix_rk4(h);
  for (int k = 0; k < steps; ++k) peer.step();
  return peer.state();
}

Vector ours_after(const Case& c, double h, int steps) {
  const rheo::EdgeForce force(std::make_shared<rheo::EdgeForm>(c.scene.mesh), rheo::best_simd_level());
  rheo::EdgeBody body(*c.model, force, 1);
  body.enter(c.interval, c.base);
  body.load(c.y);
  const auto integrator = rheo::make_integrator(rheo::IntegratorKind::rk4, body.size());
  for (int k = 0; k < steps; ++k) integrator->step(body, 0.0, h, body.state(), {});
  Vector y(static_cast<Eigen::Index>(c.y.size()));
  body.store({y.data(), c.y.size()});
  return y;
}

void report(benchmark::State& state, const Case& c, const Peer& peer) {
  bench::report_time(state, c.scene.mesh.triangle_count());
  state.counters["evaluations/step"] = peer.evaluations_per_step();
}

void report_errors(benchmark::State& state, const Case& c, const bench::StateHash& hash) {
  // A step at which the error of the fastest waves is far above rounding.
  const double h = 0.2 / c.model->element_omega;
  constexpr int steps = 32;
  const Vector exact = ours_after(c, h / 16, 16 * steps);  // 16^4 times as exact
  const auto error = [&](const Vector& y) { return (y - exact).norm() / exact.norm(); };
  const double whole = error(peer_after(c, h, steps)), half = error(peer_after(c, h / 2, 2 * steps));
  hash.report(state, whole);
  state.counters["error_engine"] = error(ours_after(c, h, steps));
  state.counters["order"] = std::log2(whole / half);
}

void rk4(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  Peer peer(c);
  peer.fix_rk4(c.step);
  for (int k = 0; k < hashed_steps; ++k) peer.step();
  const bench::StateHash hash = peer.hash();
  hash.report(state);
  for (auto _ : state) peer.step();
  report(state, c, peer);
  if (state.range(0) <= 10000) report_errors(state, c, hash);
}

void dormand_prince(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  Peer peer(c);
  peer.adapt(1e-6, 1e-6);                              // the state's numbers are of size 1
  for (int k = 0; k < hashed_steps; ++k) peer.step();  // its step finds its size
  peer.hash().report(state);
  for (auto _ : state) peer.step();
  report(state, c, peer);
  state.counters["omega*step"] = peer.last_step() * c.model->element_omega;
}

void sizes(benchmark::internal::Benchmark* b) {
  for (int triangles : {1000, 10000, 100000}) b->Arg(triangles);
  b->UseRealTime();
}

BENCHMARK(rk4)->Name("peer/rk4")->Apply(sizes);
BENCHMARK(dormand_prince)->Name("peer/dormand_prince")->Apply(sizes);

}  // namespace
