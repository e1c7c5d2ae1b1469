// Refuses a run that this machine's memory cannot hold, before it is built.
//
// An estimate: about 0.9 kB a node with lumped mass, 2.7 kB with the consistent one, whose factors fill in
// (peak resident size of `rheo check` on a rectangle of 500 x 500 nodes). The implicit integrator needs
// matrices, 2.4 and 4.5 kB a node, and for each factor kept at most 135 log2(nodes) bytes a node (from 500 to
// 500,000 nodes: rectangles 52 to 107, disks 80 to 133).
//
// Units    bytes
// Errors   Failure(usage): estimate, what the machine has and what to do; Failure(file): likewise for the
// limit
//          that a shell has set (ulimit -v)
#pragma once

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "command_line.hpp"
#include "failure.hpp"
#include "rheo/simulation.hpp"

namespace app {

// Mapped by OSMesa with LLVM, its threads (as many as processors, 16 at most) and the encoders' [bytes]; 0.77
// GB where nothing limits two processors, of which some is given up under a limit.
inline double drawing_addresses() {
  return 0.55e9 + 0.075e9 * std::clamp<double>(static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)), 1.0, 16.0);
}

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

// The shell's limit (ulimit -v); infinite where there is none.
inline double address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

// ", the shell's limit (ulimit -v) is 0.5 GB", or nothing.
inline std::string limit_text() {
  const double limit = address_space_limit();
  if (std::isinf(limit)) return {};
  return fmt::format(", the shell's limit (ulimit -v) is {:.3g} GB", limit * 1e-9);
}

// "640000 nodes need about 0.58 GB of memory, ...: take a coarser mesh"; extra: beside the scene's own.
inline std::string memory_text(const rheo::Scene& scene, const Options& options,
                               const std::string& limit = {}, double extra = 0.0) {
  return fmt::format("{} nodes{} need about {:.3g} GB of memory{}: take a coarser mesh{}{}",
                     scene.mesh.node_count(),
                     scene.time.integrator == rheo::IntegratorKind::implicit ? " with implicit" : "",
                     (memory_need(scene, options) + extra) * 1e-9, limit,
                     scene.material.mass == rheo::Mass::lumped ? "" : " or mass = \"lumped\"",
                     options.command == Command::render  ? ", or smaller pictures (--size)"
                     : options.command == Command::bench ? ", or fewer outputs (--frame-rate, --duration)"
                                                         : "");
}

inline void require_memory(const rheo::Scene& scene, const Options& options) {
  const double need = memory_need(scene, options);
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  const double page = static_cast<double>(sysconf(_SC_PAGESIZE));
  if (pages > 0.0 && page > 0.0 && need > pages * page)
    throw Failure(
        ExitCode::usage,
        memory_text(scene, options, fmt::format(", this machine has {:.3g} GB", pages * page * 1e-9)));
  // A limit counts addresses, used or not: libraries that draw map many, some of them end the program where
  // they get none.
  const double mapped = options.command == Command::render ? drawing_addresses() : 0.0;
  if (need + mapped > address_space_limit())
    throw Failure(ExitCode::file, memory_text(scene, options, limit_text(), mapped));
}

}  // namespace app
