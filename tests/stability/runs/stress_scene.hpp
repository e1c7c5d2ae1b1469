// Random scenes over decades of everything that a step's stability hangs on, small enough for all
// eigenvalues.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo::test {

struct StressScene {
  Scene scene;           // time: nothing but baumgarte and constraints
  std::string mesh;      // "plain", "sliver", "graded", "disk", "triangle"
  std::string material;  // "branch", "branches", "whole", "regions"
  std::string constraints;
  // Over and above the scene's own, which they do not contradict.
  std::vector<Constraint> redundant;
  double frequency = 0.0;  // of the first material's springs over the body's size [1/s]
  double rate = 0.0;       // its fastest relaxation [1/s]
};

// Number `number` of the sequence `seed`; the same on every machine with the same standard library.
StressScene stress_scene(std::uint64_t seed, int number);

}  // namespace rheo::test
