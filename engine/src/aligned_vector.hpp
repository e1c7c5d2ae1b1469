// Vectors that begin on a cache line: rows of 4 numbers never straddle two lines, which costs a load twice
// its time. Large ones ask for huge pages: a sweep over a large mesh reads more pages than a processor keeps
// translations for (a tenth of a step's time at 1M triangles).
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace rheo {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  static constexpr std::align_val_t huge_page{std::size_t{1} << 21};
  static constexpr std::size_t large = std::size_t{1} << 23;  // bytes; of less, a huge page would waste much

  AlignedAllocator() = default;
  template <class Other>
  AlignedAllocator(const AlignedAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
#ifdef __linux__
    // Advice: where it is refused, nothing but speed is lost.
    if (bytes >= large) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    ::operator delete(memory, alignment(count * sizeof(T)));
  }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) {
    return true;
  }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return bytes >= large ? huge_page : line;
  }
};

template <class T>
using AlignedArray = std::vector<T, AlignedAllocator<T>>;
using AlignedVector = AlignedArray<double>;

}  // namespace rheo
