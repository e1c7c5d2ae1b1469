#include "columns.hpp"

namespace rheo {

bool has_columns(const Scene& scene) {
  const bool held = !scene.fixes.empty() || !scene.moves.empty();
  return !scene.constraints.empty() || (scene.time.constraints == ConstraintMethod::baumgarte && held);
}

}  // namespace rheo
