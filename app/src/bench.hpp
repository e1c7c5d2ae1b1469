// The command bench: a scene's run time against its error, over integrators and steps.
//
// A table on standard output; in the folder bench.csv (or where --csv says), bench.png and run.json.
//
// Errors   as in runner.hpp; a run that diverges is a line of the table, no failure
#pragma once

#include "command_line.hpp"

namespace app {

void bench_scene(const Options& options);

}  // namespace app
