// How much memory may be used, and who says so.
//
// Units    bytes
#pragma once

#include <string>
#include <string_view>

namespace rheo {

struct MemoryLimit {
  double bytes = 0.0;
  std::string_view whose;  // "this machine has": begins "... 23 GB" in messages
};

// `asked` where it is not 0, else what this process can get now: what the machine has available or the
// control group's limit leaves, whichever is less. A shell's limit (ulimit -v) is of addresses, used or not,
// and no measure of need.
MemoryLimit memory_limit(double asked);

// "1.5e+05 GB", "64 MB"
std::string memory_text(double bytes);

// The end of a message about too much: "this machine has 23 GB: REMEDY, or raise the limit with
// --memory-limit"
std::string beyond(const MemoryLimit& limit, std::string_view remedy);

}  // namespace rheo
