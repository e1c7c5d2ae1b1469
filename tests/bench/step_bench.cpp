// Time of one RK4 step: the kernels against textbook RK4 on assembled matrices, on jittered unstructured
// meshes.
//
//   step/csr/<triangles>       k1..k4 with Eigen's row-major products, one for each residual force: the
//                              baseline
//   step/<kernel>/<triangles>  the engine's integrator on its operator, without energies
//   step2/edge/<triangles>     the same with two threads
//   branches/<kernel>/<triangles>/<n>  n Maxwell branches of either modulus in parallel, on one thread
//   regions/<kernel>/<triangles>       two materials in the mesh, on one thread
//   start/<triangles>          a simulation made ready: the kernel's numbers, the stable step; no file is
//                              read. From 100 triangles on, and step/edge likewise
//
// Counters: time a triangle and step; the bytes and flops that a step must at least move and do; for edge and
// element, whose sweeps pass through the mesh together, also the bytes of one such pass, which come from
// memory where the mesh is larger than the caches. Label: the hash of the state after some first steps (one
// for a kernel and level, with any number of threads). Run with
// --benchmark_enable_random_interleaving=true and --benchmark_repetitions=9 on a machine that does nothing
// else, and compare medians.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "assembled_body.hpp"
#include "bench/counters.hpp"
#include "bench/step_case.hpp"
#include "body_choice.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/element_body.hpp"
#include "regions.hpp"

namespace {

using bench::Case;
using bench::case_of;
using rheo::Vector;

constexpr int hashed_steps = 8;  // before the timed ones, from the same state

void report(benchmark::State& state, const Case& c, double bytes, double flops) {
  const double triangles = c.scene.mesh.triangle_count();
  bench::report_time(state, triangles);
  state.counters["bytes/tri"] = bytes / triangles;
  state.counters["flops/tri"] = flops / triangles;
}

// Textbook: y' = f(y) with two products, four stages, sums of whole vectors.
void step_csr(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  const rheo::Model& m = *c.model;
  const auto part = static_cast<Eigen::Index>(m.layout.part);
  Vector inverse_mass(part);
  for (Eigen::Index i = 0; i < part; ++i) inverse_mass[i] = 1.0 / m.node_mass[i / 2];
  for (const rheo::HeldDof& h : c.interval.eliminated) inverse_mass[h.dof] = 0.0;
  Vector y = Eigen::Map<const Vector>(c.y.data(), static_cast<Eigen::Index>(c.y.size()));
  Vector k1(y.size()), k2(y.size()), k3(y.size()), k4(y.size()), z(y.size()), force(part);
  const auto f = [&](const Vector& x, Vector& out) {
    force.noalias() = m.j(rheo::Modulus::lambda) * x.segment(2 * part, part);
    force.noalias() += m.j(rheo::Modulus::mu) * x.segment(3 * part, part);
    out.segment(0, part) = x.segment(part, part);
    out.segment(part, part) = inverse_mass.cwiseProduct(c.interval.force - force);
    out.segment(2 * part, part) = m.material().lambda_ela * x.segment(part, part) -
                                  m.material().lambda_rate() * x.segment(2 * part, part);
    out.segment(3 * part, part) =
        m.material().mu_ela * x.segment(part, part) - m.material().mu_rate() * x.segment(3 * part, part);
  };
  const double h = c.step;
  const auto step = [&] {
    f(y, k1);
    z = y + h / 2 * k1;
    f(z, k2);
    z = y + h / 2 * k2;
    f(z, k3);
    z = y + h * k3;
    f(z, k4);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  };
  for (int k = 0; k < hashed_steps; ++k) step();
  bench::StateHash().add({y.data(), static_cast<std::size_t>(y.size())}).report(state);
  for (auto _ : state) step();
  const auto entries =
      static_cast<double>(m.j(rheo::Modulus::lambda).nonZeros() + m.j(rheo::Modulus::mu).nonZeros());
  report(state, c, 4 * (12 * entries + 8.0 * static_cast<double>(part) * 12),
         4 * (2 * entries + 20.0 * static_cast<double>(part)));
}

// Steps of a body that stands at a state; the first ones are hashed.
void time_steps(benchmark::State& state, const Case& c, rheo::Body& body) {
  const auto integrator = rheo::make_integrator(rheo::IntegratorKind::rk4, body.size());
  const auto step = [&] {
    integrator->step(body, 0.0, c.step, body.state(), {});
    body.impose_prescribed(0.0);
  };
  for (int k = 0; k < hashed_steps; ++k) step();
  bench::StateHash().add(body.state()).report(state);
  for (auto _ : state) step();
  bench::report_time(state, c.scene.mesh.triangle_count());
}

void run_body(benchmark::State& state, const Case& c, rheo::Body& body, double bytes, double flops) {
  body.enter(c.interval, c.base);
  body.load(c.y);
  time_steps(state, c, body);
  report(state, c, bytes, flops);
}

template <rheo::SimdLevel level, int threads = 1>
void step_edge(benchmark::State& state) {
  if (!rheo::has_simd_level(level)) {
    state.SkipWithError("this processor has not these instructions");
    return;
  }
  const Case& c = case_of(static_cast<int>(state.range(0)));
  const rheo::EdgeForce force(std::make_shared<rheo::EdgeForm>(c.scene.mesh), level);
  rheo::EdgeBody body(*c.model, force, threads);
  const rheo::EdgeForm& form = force.form();
  const auto edges = static_cast<double>(form.offset.size());
  const auto nodes = static_cast<double>(form.nodes);
  // A sweep reads an edge's 5 numbers (3 on large meshes) and index, and a node's x, base and inverse mass,
  // and writes out; u once a step.
  const double edge_bytes = 8.0 * (form.level_row + 1) + 4.0;
  // A pass: all that once, u and both of the integrator's buffers included.
  state.counters["pass_bytes/tri"] =
      (edge_bytes * edges + nodes * (16 + 64 + 64 + 2 * 64)) / c.scene.mesh.triangle_count();
  run_body(state, c, body, 4 * (edge_bytes * edges + nodes * (48 + 48 + 16 + 48)) + 32 * nodes,
           4 * (20 * edges + 36 * nodes));
}

template <int threads>
void step_edge_best(benchmark::State& state) {
  switch (rheo::best_simd_level()) {
    case rheo::SimdLevel::avx512:
      return step_edge<rheo::SimdLevel::avx512, threads>(state);
    case rheo::SimdLevel::avx2:
      return step_edge<rheo::SimdLevel::avx2, threads>(state);
    case rheo::SimdLevel::baseline:
      return step_edge<rheo::SimdLevel::baseline, threads>(state);
  }
}

void step_assembled(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  rheo::AssembledBody body(*c.model, 0.0);
  const auto entries = static_cast<double>(c.model->j(rheo::Modulus::lambda).nonZeros() +
                                           c.model->j(rheo::Modulus::mu).nonZeros());
  run_body(state, c, body, 4 * (12 * entries + 8.0 * static_cast<double>(c.model->layout.part) * 10),
           4 * (2 * entries + 12.0 * static_cast<double>(c.model->layout.part)));
}

void sizes(benchmark::internal::Benchmark* b) {
  for (int triangles : {1000, 10000, 100000, 1000000}) b->Arg(triangles);
  b->UseRealTime();
}

void start(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  {
    rheo::Simulation simulation(c.scene, {.energies = false, .threads = 1});
    if (simulation.advance(simulation.step_bound())) state.SkipWithError("diverged");
    bench::StateHash().add(simulation).report(state);
  }
  for (auto _ : state) benchmark::DoNotOptimize(rheo::Simulation(c.scene, {.energies = false, .threads = 1}));
  bench::report_time(state, c.scene.mesh.triangle_count());
}

void sizes_from_100(benchmark::internal::Benchmark* b) {
  for (int triangles : {100, 200, 400, 900}) b->Arg(triangles);
  sizes(b);
}

BENCHMARK(start)->Name("start")->Apply(sizes_from_100);
BENCHMARK(step_csr)->Name("step/csr")->Apply(sizes);
BENCHMARK(step_assembled)->Name("step/assembled_horner")->Apply(sizes);
BENCHMARK(step_edge_best<1>)->Name("step/edge")->Apply(sizes_from_100);
BENCHMARK(step_edge_best<2>)->Name("step2/edge")->Apply(sizes);
BENCHMARK(step_edge<rheo::SimdLevel::baseline>)->Name("step/edge_baseline")->Apply(sizes);
BENCHMARK(step_edge<rheo::SimdLevel::avx2>)->Name("step/edge_avx2")->Apply(sizes);
BENCHMARK(step_edge<rheo::SimdLevel::avx512>)->Name("step/edge_avx512")->Apply(sizes);

// step/element: the element kernel on one material.
template <rheo::SimdLevel level, int threads = 1>
void step_element(benchmark::State& state) {
  if (!rheo::has_simd_level(level)) {
    state.SkipWithError("this processor has not these instructions");
    return;
  }
  const Case& c = case_of(static_cast<int>(state.range(0)));
  const rheo::ElementForce force(
      std::make_shared<rheo::ElementForm>(c.scene.mesh, rheo::Regions{{c.scene.material}, {}}), level);
  rheo::ElementBody body(*c.model, force, threads);
  const auto triangles = static_cast<double>(force.form().offset.size());
  const auto nodes = static_cast<double>(force.form().nodes);
  // A sweep reads a triangle's 4 numbers and 3 indices, and a node's x, base and inverse mass, and writes out
  // (forces stay in cache); u once a step. A pass: all that once, u and both of the integrator's buffers
  // included.
  state.counters["pass_bytes/tri"] = (44 * triangles + nodes * (16 + 64 + 64 + 2 * 64)) / triangles;
  run_body(state, c, body, 4 * (44 * triangles + nodes * (48 + 48 + 16 + 48)) + 32 * nodes,
           4 * (61 * triangles + 24 * nodes));
}

template <int threads>
void step_element_best(benchmark::State& state) {
  switch (rheo::best_simd_level()) {
    case rheo::SimdLevel::avx512:
      return step_element<rheo::SimdLevel::avx512, threads>(state);
    case rheo::SimdLevel::avx2:
      return step_element<rheo::SimdLevel::avx2, threads>(state);
    case rheo::SimdLevel::baseline:
      return step_element<rheo::SimdLevel::baseline, threads>(state);
  }
}

BENCHMARK(step_element_best<1>)->Name("step/element")->Apply(sizes);
BENCHMARK(step_element_best<2>)->Name("step2/element")->Apply(sizes);
BENCHMARK(step_element<rheo::SimdLevel::baseline>)->Name("step/element_baseline")->Apply(sizes);
BENCHMARK(step_element<rheo::SimdLevel::avx2>)->Name("step/element_avx2")->Apply(sizes);
BENCHMARK(step_element<rheo::SimdLevel::avx512>)->Name("step/element_avx512")->Apply(sizes);

template <rheo::Assembly assembly>
void step_branches(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  rheo::Scene scene = c.scene;
  for (int k = 1; k < state.range(1); ++k)
    scene.material.more_branches.push_back({1.0, 1.0, 1.0 / (k + 2), 0.7 / (k + 2)});
  const rheo::Model model(scene.mesh, scene.material, assembly);
  const auto body = rheo::make_body(scene, model, 1);
  body->enter(c.interval, c.base);
  std::vector<double> y(model.layout.size());
  std::copy(c.y.begin(), c.y.end(), y.begin());
  body->load(y);
  time_steps(state, c, *body);
}

void branch_sizes(benchmark::internal::Benchmark* b) {
  for (int triangles : {1000, 10000, 100000}) {
    for (int branches = 1; branches <= 8; ++branches) b->Args({triangles, branches});
  }
  b->UseRealTime();
}

BENCHMARK(step_branches<rheo::Assembly::edges>)->Name("branches/edge")->Apply(branch_sizes);
BENCHMARK(step_branches<rheo::Assembly::elements>)->Name("branches/element")->Apply(branch_sizes);

// Two materials: a disk of a stiffer one in the middle, a fifth of the triangles.
template <rheo::Assembly assembly>
void step_regions(benchmark::State& state) {
  const Case& c = case_of(static_cast<int>(state.range(0)));
  rheo::Scene scene = c.scene;
  scene.regions.push_back({"disk", {14, 20, 8, 3, 0.3, rheo::Mass::lumped}, {}, "disk"});
  for (const rheo::Triangle& t : scene.mesh.triangles) {
    const rheo::Vec2 p = scene.mesh.points[static_cast<std::size_t>(t[0])];
    scene.region_of_triangle.push_back(std::hypot(p.x - 0.5, p.y - 0.5) < 0.25 ? 1 : 0);
  }
  const rheo::Model model(scene.mesh, rheo::regions_of(scene), assembly);
  const auto body = rheo::make_body(scene, model, 1);
  rheo::Interval interval = c.interval;
  interval.solver = std::make_shared<rheo::ConstraintSolver>(model, c.held(), std::vector<rheo::Column>{});
  body->enter(interval, c.base);
  std::vector<double> y(model.layout.size(), 0.0);
  std::copy(c.y.begin(), c.y.begin() + static_cast<std::ptrdiff_t>(2 * model.layout.part), y.begin());
  body->load(y);
  time_steps(state, c, *body);
}

BENCHMARK(step_regions<rheo::Assembly::matrices>)->Name("regions/csr")->Apply(sizes);
BENCHMARK(step_regions<rheo::Assembly::elements>)->Name("regions/element")->Apply(sizes);

}  // namespace
