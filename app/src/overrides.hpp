// A scene as the command line wants it.
//
// Errors   rheo::Error of read_scene and validate; Failure(usage) for an option that the integrator has no
// use
//          for
#pragma once

#include "command_line.hpp"
#include "rheo/scene.hpp"

namespace app {

// Reads the scene file, puts the options into its [time] and [render], validates the whole.
rheo::Scene load_scene(const Options& options);

}  // namespace app
