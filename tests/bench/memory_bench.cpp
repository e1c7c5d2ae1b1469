// Memory a triangle: what the process holds more (resident) once a simulation is made and has run some steps,
// and the most that it held on the way. A table; a process of its own for each row.
//
//   rheo_bench_memory [TRIANGLES...]     default: 10000 100000 1000000
//
// The scene (mesh and groups) is counted apart: the simulation has a copy of its own. Linux only (/proc).

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "bench/step_case.hpp"
#include "rheo/simulation.hpp"

namespace {

// A line of /proc/self/status [bytes]; VmRSS: now, VmHWM: at most so far.
double resident(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return 1024.0 * std::strtod(line.c_str() + name.size() + 1, nullptr);
  return 0.0;
}

struct Way {
  const char* name;
  rheo::Kernel kernel;
  rheo::IntegratorKind integrator;
};
constexpr Way ways[] = {
    {"edge, RK4", rheo::Kernel::edge, rheo::IntegratorKind::rk4},
    {"element, RK4", rheo::Kernel::element, rheo::IntegratorKind::rk4},
    {"csr, RK4", rheo::Kernel::csr, rheo::IntegratorKind::rk4},
    {"edge, exponential", rheo::Kernel::edge, rheo::IntegratorKind::exponential},
};

int print_row(const Way& way, int triangles) {
  const double empty = resident("VmRSS");
  rheo::Scene scene = bench::jittered_square(triangles);
  scene.time.integrator = way.integrator;
  const double count = scene.mesh.triangle_count();
  const double scene_only = resident("VmRSS");
  rheo::Simulation simulation(scene, {.kernel = way.kernel, .threads = 1});
  const double length = way.integrator == rheo::IntegratorKind::rk4 ? 4.0 * simulation.step_bound() : 1e-3;
  if (simulation.advance(length)) return 1;
  fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.0f} |\n", way.name, scene.mesh.triangle_count(),
             (scene_only - empty) / count, (resident("VmRSS") - scene_only) / count,
             (resident("VmHWM") - scene_only) / count);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) {
    sizes.push_back(std::atoi(argv[i]));
    if (sizes.back() < 2) {
      fmt::print(stderr, "{}: a number of triangles from 2 is needed\n", argv[i]);
      return 2;
    }
  }
  if (sizes.empty()) sizes = {10000, 100000, 1000000};
  fmt::print(
      "Resident bytes a triangle.\n\n| kernel, integrator | triangles | scene | simulation | at most, while "
      "it is made "
      "|\n|---|---|---|---|---|\n");
  std::fflush(stdout);
  int status = 0;
  for (const Way& way : ways) {
    for (const int triangles : sizes) {
      const pid_t child = fork();
      if (child == 0) {
        const int result = print_row(way, triangles);
        std::fflush(stdout);
        _exit(result);
      }
      int state = 0;
      waitpid(child, &state, 0);
      if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) status = 1;
    }
  }
  return status;
}
