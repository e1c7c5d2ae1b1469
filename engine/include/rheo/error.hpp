// The one exception of the engine: bad input or a file that cannot be read or written.
//
// Thrown while loading and constructing only, never from a step. The text is one line that says where (file
// and line, or the item), the value, what is allowed and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace rheo {

class Error : public std::runtime_error {
 public:
  enum class Kind {
    input,  // a value, key, mesh or constraint that cannot be used; the program's exit code 2
    file    // the operating system refused to read or write; exit code 4
  };

  Error(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace rheo
