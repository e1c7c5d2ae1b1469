// Memory that a scene may ask for, booked before it is.
//
// Units    bytes
// Errors   Error::Kind::input: what needs how much, the limit and the option that raises it
#pragma once

#include <algorithm>
#include <string_view>

#include "rheo/memory_limit.hpp"

namespace rheo {

class MemoryBudget {
 public:
  explicit MemoryBudget(const MemoryLimit& limit) : limit_(limit) {}

  // `what` needs the bytes ("1e+12 nodes"); `remedy`: what to do where they are not left.
  void take(double bytes, std::string_view what, std::string_view remedy);
  // At least 1: 0 would stand for what the machine has.
  double left() const { return std::max(1.0, limit_.bytes - taken_); }

 private:
  MemoryLimit limit_;
  double taken_ = 0.0;
};

}  // namespace rheo
