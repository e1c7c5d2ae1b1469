// What the user should know about a run before it starts: the reader's notes, a mesh in pieces, holds and
// loads that never act, and times at which nothing is written.
//
// Units    s
#pragma once

#include <string>
#include <vector>

#include "rheo/scene.hpp"
#include "rheo/simulation.hpp"

namespace app {

std::vector<std::string> run_notes(const rheo::Scene& scene);

// What was chosen for an accuracy, in one line.
std::string plan_text(const rheo::AccuracyPlan& plan);

// That, and which columns of history.csv the chosen integrator leaves empty; none where no accuracy was asked
// for.
std::vector<std::string> plan_notes(const rheo::Simulation& simulation,
                                    const rheo::SimulationOptions& options);

}  // namespace app
