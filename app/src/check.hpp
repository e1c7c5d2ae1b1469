// The command check: a scene validated, its sizes, spectrum, stable steps and what a run would cost.
//
// The cost is a forecast: some dozens of real steps of this scene are timed and extrapolated.
//
// Errors   as in runner.hpp
#pragma once

#include "command_line.hpp"

namespace app {

void check_scene(const Options& options);

}  // namespace app
