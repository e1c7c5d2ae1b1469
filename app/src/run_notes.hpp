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

// Where relaxation or the viscous part alone makes explicit steps many times shorter than the vibrations do:
// what to do; else empty.
std::string stiffness_advice(const rheo::Scene& scene, const rheo::Spectrum& spectrum);

// What was chosen for an accuracy, in one line.
std::string plan_text(const rheo::AccuracyPlan& plan);

// The advice, and where an accuracy was asked for what was chosen and which columns of history.csv the chosen
// integrator leaves empty.
std::vector<std::string> plan_notes(const rheo::Simulation& simulation,
                                    const rheo::SimulationOptions& options);

}  // namespace app
