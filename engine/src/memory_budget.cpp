#include "memory_budget.hpp"

#include <fmt/format.h>

#include "rheo/error.hpp"

namespace rheo {

void MemoryBudget::take(double bytes, std::string_view what, std::string_view remedy) {
  if (bytes > left()) {
    throw Error(Error::Kind::input,
                fmt::format("{} need about {} of memory{}, {}", what, memory_text(bytes),
                            taken_ > 0.01 * limit_.bytes
                                ? fmt::format(" beside {} for what is there already", memory_text(taken_))
                                : "",
                            beyond(limit_, remedy)));
  }
  taken_ += bytes;
}

}  // namespace rheo
