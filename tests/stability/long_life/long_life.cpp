// Bodies pulled back and forth for ever: drift, speed and memory tenth by tenth of the run.
//
//   rheo_long_life [--share S] [--only TEXT]
//
// S: of the whole, 1e8 steps of the beam, 1e6 of 10k triangles, 1e5 frames of exponential and implicit each;
// default 1. TEXT: only runs with it in their name.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "stability/runs/long_life_run.hpp"

namespace {

using rheo::IntegratorKind;
using rheo::test::LongLife;
using rheo::test::LongLifeOutcome;
using rheo::test::Tenth;

// So many periods that there are `steps` of them at least.
std::int64_t periods_for(LongLife life, double steps) {
  life.periods = 10;
  const LongLifeOutcome tried = rheo::test::live_long(life);
  return 10 * static_cast<std::int64_t>(std::ceil(steps / static_cast<double>(tried.steps())));
}

bool run(const std::string& name, LongLife life) {
  const LongLifeOutcome outcome = rheo::test::live_long(life);
  fmt::print("{}: {:.4g} steps, {:.4g} ticks\n", name, static_cast<double>(outcome.steps()),
             static_cast<double>(life.periods * life.ticks_a_period));
  fmt::print("{:>7} {:>12} {:>10} {:>12} {:>12} {:>12} {:>10}\n", "tenth", "steps", "ns/step", "evaluations",
             "drift", "balance", "RSS [kB]");
  std::int64_t steps = 0;
  for (std::size_t k = 0; k < outcome.tenths.size(); ++k) {
    const Tenth& t = outcome.tenths[k];
    steps += t.steps;
    fmt::print("{:>7} {:>12} {:>10.1f} {:>12.2f} {:>12.2e} {:>12.2e} {:>10}\n", k + 1, steps,
               1e9 * t.seconds / static_cast<double>(t.steps), t.evaluations, t.drift, t.balance,
               t.memory / 1024);
  }
  const double allowed = outcome.allowed_drift();
  const bool fine = !outcome.diverged && outcome.finite && outcome.worst_drift() <= allowed;
  fmt::print("drift {:.2e}, allowed {:.2e}: {}\n\n", outcome.worst_drift(), allowed,
             fine ? "fine" : "BROKEN");
  std::fflush(stdout);
  return fine;
}

struct Wanted {
  double share = 1.0;
  std::string only;
};

Wanted wanted(int argc, char** argv) {
  Wanted all;
  for (int k = 1; k < argc; k += 2) {
    const std::string_view option = argv[k];
    if (k + 1 == argc || (option != "--share" && option != "--only"))
      throw std::invalid_argument("only --share S and --only TEXT are known");
    if (option == "--share")
      all.share = std::stod(argv[k + 1]);
    else
      all.only = argv[k + 1];
  }
  return all;
}

int run_all(const Wanted& wanted) {
  using rheo::test::long_lived_beam;
  using rheo::test::long_lived_block;
  bool fine = true;
  int runs = 0;
  const auto run_if_wanted = [&](const std::string& name, LongLife life, double steps) {
    if (name.find(wanted.only) == std::string::npos) return;
    life.periods = periods_for(life, wanted.share * steps);
    fine &= run(name, life);
    ++runs;
  };
  run_if_wanted("beam, rk4", long_lived_beam(IntegratorKind::rk4, 10), 1e8);
  for (const auto& [kind, name] :
       {std::pair{IntegratorKind::exponential, "exponential"}, {IntegratorKind::implicit, "implicit"}}) {
    // A step a tick: frames.
    run_if_wanted(fmt::format("beam, {}", name), long_lived_beam(kind, 10), 1e5);
    run_if_wanted(fmt::format("block of 80 triangles, {}", name), long_lived_block(kind, 11, 5, 10), 1e5);
  }
  LongLife large = long_lived_block(IntegratorKind::rk4, 101, 51, 10);
  large.ticks_a_period = 20;
  run_if_wanted("block of 10,000 triangles, rk4", large, 1e6);
  if (runs == 0) throw std::invalid_argument(fmt::format("no run has \"{}\" in its name", wanted.only));
  return fine ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_all(wanted(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "rheo_long_life: {}\n", error.what());
    return 2;
  }
}
