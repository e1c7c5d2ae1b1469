// Checkpoints: all of a simulation's state in one file, from which it goes on to the same bits.
//
//   "rheo ck\n", u32 version, u32 0x01020304 (byte order), u64 length of the file, u64 mesh, u64 motion
//   (fingerprint.hpp), then t, u, v, w of each branch (SavedState), the course (Snapshot), the companion, and
//   a u64 checksum of all before it
//
// The companion is whatever the program that writes the file wants to keep beside it. The file appears whole
// or not at all, and is on the disk, not on its way there, when write_checkpoint returns.
//
// Units    SI
// Errors   Error::Kind::file where it cannot be read or written; Error::Kind::input, named by what it is: no
//          checkpoint, one of another version or byte order, truncated, damaged, of another mesh or scene
// Not here promises across builds: another compiler or processor may round otherwise
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "rheo/simulation.hpp"

namespace rheo {

inline constexpr std::uint32_t checkpoint_version = 2;

struct Checkpoint {
  std::filesystem::path file;  // for messages
  std::uint64_t mesh = 0, motion = 0;
  Snapshot snapshot;
  std::string companion;
};

void write_checkpoint(const std::filesystem::path& file, Simulation& simulation,
                      std::string_view companion = {});
Checkpoint read_checkpoint(const std::filesystem::path& file);

// The run goes on where the checkpoint was written, to the same bits: the same scene, options and build.
void go_on(Simulation& simulation, const Checkpoint& checkpoint);
// The simulation begins, at t = 0, with the checkpoint's shape, velocities and residual forces: the same
// mesh; what else the scene says may be another. Branches that only one of both has begin at zero.
void begin_from(Simulation& simulation, const Checkpoint& checkpoint);

}  // namespace rheo
