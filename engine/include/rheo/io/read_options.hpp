// What a scene file may ask of the machine that reads it: it may come from a stranger.
#pragma once

#include "rheo/limits.hpp"

namespace rheo {

// Files that a scene names (a mesh, tables of keys, measured data) and that lie neither beside nor below it,
// symbolic links resolved.
enum class OutsideFiles { refused, allowed };

struct ReadOptions {
  OutsideFiles outside = OutsideFiles::refused;
  double memory = 0.0;  // [bytes] that the scene and its mesh may take; 0: what this machine has available
  double outputs = max_outputs;  // that its duration and frame rate may give
};

}  // namespace rheo
