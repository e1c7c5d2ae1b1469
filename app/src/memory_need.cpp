#include "memory_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "drawing_room.hpp"
#include "failure.hpp"
#include "frame_outputs.hpp"
#include "rheo/memory_limit.hpp"
#include "rheo/memory_need.hpp"
#include "rheo/simulation.hpp"

namespace app {
namespace {

// Beside the simulation's.
double need_of_command(const rheo::Scene& scene, const Options& options) {
  const double nodes = scene.mesh.node_count();
  const auto outputs = static_cast<double>(rheo::output_count(scene.time));
  double need = 0.0;
  if (options.vtu) need += rheo::bytes_an_output * outputs;
  if (options.command == Command::render) {
    const double pixels = static_cast<double>(scene.picture.size[0]) * scene.picture.size[1];
    // Each encoder has two pictures; bytes_a_pixel holds those of two encoders.
    need += pixels * (rheo::bytes_a_pixel + 8.0 * (options.threads - 2)) + rheo::bytes_an_output * outputs;
    // Beyond this the recorded outputs go to a file (frame_store.hpp).
    constexpr double kept = 256.0 * 1024.0 * 1024.0;
    const std::int64_t shapes = most_kept(rheo::output_count(scene.time), scene.picture.every);
    need += std::min(kept, static_cast<double>(shapes) * nodes * 12.0);
  }
  // The exact states at all outputs, and others to check them by.
  if (options.command == Command::bench) need += 2.0 * 64.0 * nodes * outputs;
  return need;
}

// What makes that smaller.
const char* remedy_of(const Options& options) {
  return options.command == Command::render  ? "smaller pictures (--size) or fewer (--every, --frame-rate)"
         : options.command == Command::bench ? "fewer outputs (--frame-rate, --duration)"
                                             : "";
}

}  // namespace

std::string limit_text() {
  const double limit = address_space_limit();
  if (std::isinf(limit)) return {};
  return fmt::format(", the shell's limit (ulimit -v) is {:.3g} GB", limit * 1e-9);
}

std::string memory_text(const rheo::Scene& scene, const Options& options, const std::string& limit,
                        double extra) {
  const std::string remedy = remedy_of(options);
  const double need = rheo::memory_need(scene).total() + need_of_command(scene, options) + extra;
  return fmt::format(
      "{} nodes{} need about {:.3g} GB of memory{}: take a coarser mesh{}{}", scene.mesh.node_count(),
      scene.time.integrator == rheo::IntegratorKind::implicit ? " with implicit" : "", need * 1e-9, limit,
      scene.material.mass == rheo::Mass::lumped ? "" : " or mass = \"lumped\"",
      remedy.empty() ? "" : ", or " + remedy);
}

void require_memory(const rheo::Scene& scene, const Options& options) {
  const double also = need_of_command(scene, options);
  if (options.read.memory == 0.0) {
    // A limit counts addresses, used or not: libraries that draw map many, some of them end the program where
    // they get none.
    const bool draws = options.command == Command::render || options.command == Command::view;
    const double mapped = draws ? drawing_addresses() : 0.0;
    if (rheo::memory_need(scene).total() + also + mapped > address_space_limit())
      throw Failure(ExitCode::file, memory_text(scene, options, limit_text(), mapped));
  }
  rheo::require_memory(scene, options.read.memory, also, remedy_of(options));
}

void telling_need(const rheo::Scene& scene, const Options& options, const std::function<void()>& work) {
  // Made while there is memory for it.
  const std::string text = "out of memory: " + memory_text(scene, options, limit_text());
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw Failure(ExitCode::file, text);
  }
}

}  // namespace app
