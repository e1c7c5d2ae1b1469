// What a scene may use while it is read.
#pragma once

#include "io/file_access.hpp"
#include "memory_budget.hpp"

namespace rheo {

struct Allowance {
  FileAccess files;
  MemoryBudget memory;
};

}  // namespace rheo
