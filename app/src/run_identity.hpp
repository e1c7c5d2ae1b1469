// What a run's results hang on, as lines "name: value": a cut run is gone on with only where all of them are
// the same.
//
// Threads and what is printed are not among them: results never depend on those.
// Errors   none
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "rheo/scene.hpp"
#include "run_report.hpp"

namespace app {

// scene: as load_scene gave it, before anything was chosen for its accuracy.
std::string run_identity(const Options& options, const rheo::Scene& scene, const std::string& scene_text,
                         const std::vector<Fingerprint>& read_files);

// "--duration 5, not 6": the first line in which a run was another; nothing where there is none.
std::optional<std::string> first_difference(const std::string& then, const std::string& now);

}  // namespace app
