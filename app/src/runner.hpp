// The commands run and render: one scene simulated, its results written, for render also drawn.
//
// Everything that can be refused is refused before the output folder is made: options, scene, step, graphics.
// A cut run is gone on with from its checkpoint (run_checkpoint.hpp): its tables and frames come to the same
// bytes.
//
// Errors   Failure, rheo::Error, std::runtime_error of the renderer. A divergence is a Failure(diverged)
// after the
//          files of the outputs before it were written; SIGINT and SIGTERM are Failure(interrupted),
//          Failure(terminated) after the output in hand; std::bad_alloc is Failure(file) with the estimate
#pragma once

#include "command_line.hpp"

namespace app {

void run_scene(const Options& options);

}  // namespace app
