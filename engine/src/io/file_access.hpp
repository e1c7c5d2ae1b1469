// Which files a scene may read: regular ones, beside or below itself unless more is allowed.
//
// Errors   Error::Kind::input: a path that leads out of the scene's folder (absolute, by "..", by symbolic
//          links), a name with control characters, a device or a pipe, which could make the reader wait for
//          ever; Error::Kind::file where a path cannot be followed
#pragma once

#include <filesystem>
#include <string>

#include "rheo/io/read_options.hpp"

namespace rheo {

class FileAccess {
 public:
  // `folder`: where relative paths start; empty: the current one.
  FileAccess(std::filesystem::path folder, OutsideFiles outside)
      : folder_(std::move(folder)), outside_(outside) {}

  // The path of a file by the name that the scene has for it. That there is such a file is left to who reads
  // it.
  std::filesystem::path resolve(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  OutsideFiles outside_;
};

}  // namespace rheo
