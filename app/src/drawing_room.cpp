#include "drawing_room.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "failure.hpp"

namespace app {
namespace {

// Of this program so far; 0 where the system does not tell.
double mapped_addresses() {
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

double address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

// By OSMesa with LLVM, its threads (as many as processors, 16 at most) and the encoders'; 0.77 GB where
// nothing limits two processors, of which some is given up under a limit.
double drawing_addresses() {
  return 0.55e9 + 0.075e9 * std::clamp<double>(static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)), 1.0, 16.0);
}

void require_drawing_room() {
  const double limit = address_space_limit();
  if (std::isinf(limit)) return;
  const double need = mapped_addresses() + drawing_addresses();
  if (need > limit)
    throw Failure(
        ExitCode::file,
        fmt::format("no room to draw: pictures need about {:.3g} GB of addresses, the shell's limit "
                    "(ulimit -v) is {:.3g} GB: raise it",
                    need * 1e-9, limit * 1e-9));
}

}  // namespace app
