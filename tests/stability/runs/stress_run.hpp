// One scene of the stress matrix under one explicit integrator: is what is predicted true, is what is stable
// stable, and is what is not refused or noticed?
#pragma once

#include <string>
#include <vector>

#include "stability/runs/stress_scene.hpp"
#include "stability/runs/true_limit.hpp"

namespace rheo::test {

enum class Promise {
  limit,     // no step beyond the true limit is called stable
  nearness,  // what is called stable is 95 % of the true limit at least
  stable,    // at 0.99 of it nothing is taken for a divergence or grows beyond the work, by Euler beyond 1.03
  refused,   // 1.05 of the true limit is refused
  named,     // of redundant constraints it is said that they are, or they are taken and the rest is kept
  noticed    // allowed, it ends in a divergence before a look shows more than 1.04 of the work
};
inline constexpr Promise promises[] = {Promise::limit,   Promise::nearness, Promise::stable,
                                       Promise::refused, Promise::named,    Promise::noticed};

struct Broken {
  Promise promise;
  std::string text;
};

struct StressOutcome {
  double predicted = 0.0;
  TrueLimit truth;
  double worst_energy = 0.0;  // (kinetic + stored) / work at 0.99 of the prediction, the largest at the looks
  double first_energy = 0.0;  // the same in the first five steps
  bool refused_beyond = true;  // 1.05 of the truth, without leave
  bool grew = false;           // run with leave: diverged, and said so
  std::vector<Broken> broken;  // empty: all kept
};

// How long it is run, and when its energies are looked at: after each of the first steps, then evenly.
struct StressLength {
  int steps = 10000;
  int one_by_one = 1000;
  int later = 1000;
};

// The engine's word on a scene's redundant constraints: taken, and then part of the scene, or refused. The
// scene has none of them beside it any more.
struct Redundancy {
  bool any = false;
  bool refused = false;
  std::vector<Broken> broken;  // where the reason is another
};
Redundancy settle(StressScene& stress);

// truth: the scene's, which has no redundant constraints beside it.
StressOutcome stress(const StressScene& stress, const TrueSpectrum& truth, IntegratorKind integrator,
                     const StressLength& length = {});

}  // namespace rheo::test
