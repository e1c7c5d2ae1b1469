#include "rheo/io/mesh_file.hpp"

#include "rheo/error.hpp"

namespace rheo {
Mesh read_msh(const std::filesystem::path& file) {
  throw Error(Error::Kind::input, file.string());
}
}  // namespace rheo
