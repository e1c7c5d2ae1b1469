// The commands run and render: one scene simulated, its results written, for render also drawn.
//
// Everything that can be refused is refused before the output folder is made: options, scene, step, graphics.
//
// Errors   Failure, rheo::Error, std::runtime_error of the renderer. A divergence is a Failure(diverged)
// after the
//          files of the outputs before it were written
#pragma once

#include "command_line.hpp"

namespace app {

void run_scene(const Options& options);

}  // namespace app
