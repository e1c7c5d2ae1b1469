// One writer, one reader, the newest whole value; neither ever waits for the other.
//
// Errors   none
// Threads  back(), publish(): the writer's; newest(): the reader's
#pragma once

#include <array>
#include <atomic>

namespace app::view {

template <class Value>
class TripleBuffer {
 public:
  Value& back() { return values_[back_]; }
  void publish() { back_ = middle_.exchange(back_ | fresh, std::memory_order_acq_rel) & index; }
  // Whether the reader has not taken the last one yet.
  bool waits() const { return (middle_.load(std::memory_order_relaxed) & fresh) != 0; }

  // The newest published value, or the same as before.
  const Value& newest() {
    if (waits()) front_ = middle_.exchange(front_, std::memory_order_acq_rel) & index;
    return values_[front_];
  }

 private:
  static constexpr unsigned fresh = 4, index = 3;
  std::array<Value, 3> values_{};
  unsigned back_ = 0, front_ = 2;
  std::atomic<unsigned> middle_{1};
};

}  // namespace app::view
