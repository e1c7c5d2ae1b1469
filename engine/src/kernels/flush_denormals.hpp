// While one lives, this thread takes denormal numbers (below 2e-308) for zero: arithmetic on them is a
// hundred times slower on many processors, and a body that has relaxed for long is full of them.
//
// Nothing is lost: a number of the state is compared with others of its size at 1e-300 nowhere.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#include <xmmintrin.h>
#endif

namespace rheo {

class FlushDenormals {
 public:
#if defined(__x86_64__) && defined(__GNUC__)
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | flush_to_zero | denormals_are_zero);
  }
  ~FlushDenormals() {
    _mm_setcsr(before_);
  }
#else
  FlushDenormals() = default;
#endif
  // Whether this thread does now, for results and arguments.
  static bool is_on() {
#if defined(__x86_64__) && defined(__GNUC__)
    constexpr unsigned both = flush_to_zero | denormals_are_zero;
    return (_mm_getcsr() & both) == both;
#else
    return false;
#endif
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__x86_64__) && defined(__GNUC__)
  static constexpr unsigned flush_to_zero = 0x8000;
  static constexpr unsigned denormals_are_zero = 0x0040;
  unsigned before_;
#endif
};

}  // namespace rheo
