// Refuses a run that this machine's memory cannot hold, before it is built.
//
// An estimate: about 0.9 kB a node with lumped mass, 2.7 kB with the consistent one, whose factors fill in
// (peak resident size of `rheo check` on a rectangle of 500 x 500 nodes). The implicit integrator needs
// matrices, 2.4 and 4.5 kB a node, and for each factor kept at most 135 log2(nodes) bytes a node (from 500 to
// 500,000 nodes: rectangles 52 to 107, disks 80 to 133).
//
// Units    bytes
// Errors   Failure(usage): estimate, limit and what to do
#pragma once

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "command_line.hpp"
#include "failure.hpp"
#include "rheo/simulation.hpp"

namespace app {

inline double implicit_need(const rheo::Scene& scene) {
  const double nodes = scene.mesh.node_count();
  const double factor = 135.0 * std::log2(nodes) * nodes;
  return nodes * (scene.material.mass == rheo::Mass::lumped ? 2400.0 : 4500.0) +
         std::max(rheo::fewest_factors * factor, std::min(rheo::most_factors * factor, rheo::factors_budget));
}

inline double memory_need(const rheo::Scene& scene, const Options& options) {
  const double nodes = scene.mesh.node_count();
  double need = nodes * (scene.material.mass == rheo::Mass::lumped ? 900.0 : 2700.0);
  if (scene.time.integrator == rheo::IntegratorKind::implicit) need = implicit_need(scene);
  if (scene.time.accuracy > 0.0 && scene.time.integrator != rheo::IntegratorKind::exponential) {
    // Two trial runs side by side, whose states at the outputs may be kept (trial_runs.cpp).
    need += need + 2.0 * std::min(128e6, 64.0 * nodes * static_cast<double>(rheo::output_count(scene.time)));
  }
  if (options.command == Command::render) {
    const double pixels = static_cast<double>(scene.picture.size[0]) * scene.picture.size[1];
    // Frame buffers of 4 samples with depth, and two pictures for every encoder.
    need += pixels * (4.0 * 8.0 + 8.0 * options.threads);
    // Beyond this the recorded outputs go to a file (frame_store.hpp).
    constexpr double kept = 256.0 * 1024.0 * 1024.0;
    need += std::min(kept, static_cast<double>(rheo::output_count(scene.time)) * nodes * 12.0);
  }
  // The exact states at all outputs, and others to check them by.
  if (options.command == Command::bench)
    need += 2.0 * 64.0 * nodes * static_cast<double>(rheo::output_count(scene.time));
  return need;
}

inline void require_memory(const rheo::Scene& scene, const Options& options) {
  const double need = memory_need(scene, options);
  const auto refuse_beyond = [&](double limit, const char* whose) {
    if (need <= limit) return;
    throw Failure(
        ExitCode::usage,
        fmt::format("{} nodes{} need about {:.3g} GB of memory, {} {:.3g} GB: take a coarser mesh{}{}",
                    scene.mesh.node_count(),
                    scene.time.integrator == rheo::IntegratorKind::implicit ? " with implicit" : "",
                    need * 1e-9, whose, limit * 1e-9,
                    scene.material.mass == rheo::Mass::lumped ? "" : " or mass = \"lumped\"",
                    options.command == Command::render  ? ", or smaller pictures (--size)"
                    : options.command == Command::bench ? ", or fewer outputs (--frame-rate, --duration)"
                                                        : ""));
  };
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  const double page = static_cast<double>(sysconf(_SC_PAGESIZE));
  if (pages > 0.0 && page > 0.0) refuse_beyond(pages * page, "this machine has");
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    refuse_beyond(static_cast<double>(limit.rlim_cur), "the shell's limit (ulimit -v) is");
}

}  // namespace app
