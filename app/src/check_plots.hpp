// What `rheo check --plot` writes: relaxation.csv, moduli.csv, relaxation.png, moduli.png, where data were
// given fit.png, and run.json, by which a later call knows the files. A machine that cannot draw makes the
// tables.
//
// Errors   Failure as in output_folder.hpp; rheo::Error::Kind::file; std::runtime_error of the renderer
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "output_folder.hpp"
#include "rheo/scene.hpp"

namespace app {

// Returns notes for the user. `folder` lists what was made.
std::vector<std::string> write_plots(const rheo::Scene& scene, const Options& options, OutputFolder& folder);

}  // namespace app
