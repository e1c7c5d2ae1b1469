// What a run says at its end.
#pragma once

#include <cstdint>
#include <string>

#include "output_folder.hpp"
#include "phase_clock.hpp"
#include "progress.hpp"
#include "rheo/simulation.hpp"

namespace app {

// When and where, and what to do about it.
std::string divergence_text(const rheo::Divergence& divergence, const rheo::Simulation& simulation);

// Steps, evaluations and seconds by phase.
void summarise(const rheo::Counters& counters, const Seconds& seconds, std::int64_t frames,
               Progress& progress);

// One line a file; frames and .vtu files as one line each.
void list_files(const OutputFolder& folder, Progress& progress);

}  // namespace app
