// What a command needs of memory, and the refusal of all that is too much, before it is built.
//
// Units    bytes
// Errors   rheo::Error (input): estimate, what the machine has or --memory-limit allows and what to do;
//          Failure(file): likewise for the limit that a shell has set (ulimit -v)
#pragma once

#include <functional>
#include <string>

#include "command_line.hpp"

namespace app {

// ", the shell's limit (ulimit -v) is 0.5 GB", or nothing.
std::string limit_text();

// "640000 nodes need about 0.58 GB of memory, ...: take a coarser mesh"; extra: beside the scene's own.
std::string memory_text(const rheo::Scene& scene, const Options& options, const std::string& limit = {},
                        double extra = 0.0);

void require_memory(const rheo::Scene& scene, const Options& options);

// Does `work`; memory that runs out in it is a Failure(file) with the estimate.
void telling_need(const rheo::Scene& scene, const Options& options, const std::function<void()>& work);

}  // namespace app
