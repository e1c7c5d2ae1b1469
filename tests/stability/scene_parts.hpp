// What the engine has of a scene before it chooses a step.
#pragma once

#include <memory>

#include "model.hpp"
#include "regions.hpp"
#include "schedule.hpp"

namespace rheo::test {

// What the engine has of a scene, without its eigenvalues.
struct Parts {
  explicit Parts(const Scene& scene)
      : model(scene.mesh, regions_of(scene)),
        schedule(scene, model, 0.0, Nearness::safe),
        solver(schedule.interval(0).solver),
        spectrum(schedule.spectrum()) {
    spectrum.eigenvalues.clear();
  }

  Model model;
  Schedule schedule;
  std::shared_ptr<const ConstraintSolver> solver;
  Spectrum spectrum;
};

}  // namespace rheo::test
