// `rheo view`: a scene in a window, until it is closed.
//
// Errors   those of load_scene; Failure(usage) where no window can be had: it names `rheo render`
#pragma once

#include "command_line.hpp"

namespace app {

void view_scene(const Options& options);

}  // namespace app
