#include "support/allocation_count.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD) || !defined(__GLIBC__)
#define RHEO_CANNOT_COUNT 1
#endif

namespace {

std::atomic<bool> counting{false};
std::atomic<std::int64_t> calls{0}, held{0}, most{0};

#ifndef RHEO_CANNOT_COUNT
void* note(void* memory) {
  if (memory == nullptr || !counting.load(std::memory_order_relaxed)) return memory;
  calls.fetch_add(1, std::memory_order_relaxed);
  const auto bytes = static_cast<std::int64_t>(malloc_usable_size(memory));
  const std::int64_t now = held.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  std::int64_t before = most.load(std::memory_order_relaxed);
  while (before < now && !most.compare_exchange_weak(before, now, std::memory_order_relaxed)) {
  }
  return memory;
}

void note_end(void* memory) {
  if (memory != nullptr && counting.load(std::memory_order_relaxed))
    held.fetch_sub(static_cast<std::int64_t>(malloc_usable_size(memory)), std::memory_order_relaxed);
}
#endif

}  // namespace

#ifndef RHEO_CANNOT_COUNT
// glibc's own names behind the program's.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) noexcept {
  return note(__libc_malloc(size));
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  return note(__libc_calloc(number, size));
}
void* realloc(void* memory, std::size_t size) noexcept {
  note_end(memory);
  return note(__libc_realloc(memory, size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return note(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return note(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = note(__libc_memalign(alignment, size));
  return *memory == nullptr ? 12 : 0;
}
void free(void* memory) noexcept {
  note_end(memory);
  __libc_free(memory);
}
}
#endif

namespace rheo::test {

bool can_count_allocations() {
#ifdef RHEO_CANNOT_COUNT
  return false;
#else
  return true;
#endif
}

AllocationCount::AllocationCount() {
  calls = held = most = 0;
  counting = true;
}

AllocationCount::~AllocationCount() {
  counting = false;
}

Allocations AllocationCount::so_far() const {
  return {calls.load(), held.load(), most.load()};
}

}  // namespace rheo::test
