#include "rheo/versions.hpp"

#include <fmt/format.h>

#include <Eigen/Core>

#include "io/toml_tree.hpp"

namespace rheo {

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"tomlplusplus", toml_version()}};
}

}  // namespace rheo
