// What the program allocates while it is counted: calls, bytes held at the end, bytes held at most on the
// way.
//
// Everything is seen, whatever thread and library it is in (operator new too). Bytes are those that the
// allocator set aside: somewhat more than were asked for.
//
// Not here sanitizers, whose allocators are their own, and libraries other than glibc:
// can_count_allocations()
#pragma once

#include <cstdint>

namespace rheo::test {

bool can_count_allocations();

struct Allocations {
  std::int64_t calls = 0;
  std::int64_t held = 0;  // [bytes]; frees of what was there before count too
  std::int64_t most = 0;  // [bytes]
};

// Counts from its making on; one at a time.
class AllocationCount {
 public:
  AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;
  ~AllocationCount();

  Allocations so_far() const;
};

}  // namespace rheo::test
