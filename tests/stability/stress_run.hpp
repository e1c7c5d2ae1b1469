// One scene of the stress matrix under one explicit integrator: is what is predicted true, is what is stable
// stable, and is what is not refused or noticed?
#pragma once

#include <string>
#include <vector>

#include "stress_scene.hpp"
#include "true_limit.hpp"

namespace rheo::test {

struct StressOutcome {
  double predicted = 0.0;
  TrueLimit truth;
  double worst_energy =
      0.0;  // (kinetic + stored) / work at 0.99 of the prediction, the largest at the outputs
  bool refused_beyond = true;       // 1.05 of the truth, without leave
  bool grew = false;                // run with leave: diverged, and said so
  std::vector<std::string> broken;  // promises; empty: all kept
};

struct StressLength {
  int steps = 10000;
  int outputs = 20;
};

StressOutcome stress(const StressScene& stress, IntegratorKind integrator, const StressLength& length = {});

}  // namespace rheo::test
