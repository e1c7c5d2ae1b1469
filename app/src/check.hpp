// The command check: a scene validated, its sizes, spectrum, stable steps and what a run would cost.
//
// The cost is a forecast: some dozens of real steps of this scene are timed and extrapolated. With --plot the
// material's curves are drawn as well (check_plots.hpp); without it nothing is written and no graphics
// library is loaded.
//
// Errors   as in runner.hpp and check_plots.hpp
#pragma once

#include "command_line.hpp"

namespace app {

void check_scene(const Options& options);

}  // namespace app
