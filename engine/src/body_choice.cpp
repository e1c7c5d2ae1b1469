#include "body_choice.hpp"

#include <fmt/format.h>

#include "assembled_body.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/element_body.hpp"
#include "kernels/parallel_edge_body.hpp"
#include "kernels/parallel_element_body.hpp"
#include "rheo/error.hpp"
#include "schedule.hpp"
#include "shifted_body.hpp"

namespace rheo {

Assembly assembly_for(const Scene& scene, Kernel kernel, SimdLevel level) {
  const bool implicit = scene.time.integrator == IntegratorKind::implicit;
  const bool asked = kernel == Kernel::edge || kernel == Kernel::element;
  const char* name = kernel == Kernel::edge ? "edge" : "element";
  if (asked && implicit) {
    throw Error(
        Error::Kind::input,
        fmt::format("kernel {} has no matrices, which integrator = \"implicit\" factors: use auto or csr",
                    name));
  }
  const bool by_nodes = scene.material.mass == Mass::lumped && !has_columns(scene) && !implicit;
  if (asked && !by_nodes) {
    throw Error(Error::Kind::input,
                fmt::format("kernel {} needs mass = \"lumped\" and constraints = \"auto\" without "
                            "[[constraint]]: use auto or csr",
                            name));
  }
  const Regions regions = regions_of(scene);
  if (kernel == Kernel::edge && regions.several()) {
    throw Error(Error::Kind::input,
                "kernel edge needs one material in all of the mesh: use auto, element or csr");
  }
  const bool one_thickness = scene.mesh.thickness_of_node.empty();
  if (kernel == Kernel::edge && !one_thickness) {
    throw Error(Error::Kind::input,
                "kernel edge needs one thickness in all bodies: use auto, element or csr");
  }
  if (kernel == Kernel::element) return Assembly::elements;
  if (kernel == Kernel::csr || !by_nodes) return Assembly::matrices;
  if (regions.several() || !one_thickness) return Assembly::elements;
  const bool narrow = level == SimdLevel::baseline && !combined(regions.materials.front());
  return kernel == Kernel::automatic && narrow ? Assembly::elements : Assembly::edges;
}

std::unique_ptr<Body> make_body(const Scene& scene, const Model& model, int threads) {
  const bool parallel = model.is_parallel();
  if (model.edges && parallel) return std::make_unique<ParallelEdgeBody>(model, *model.edges, threads);
  if (model.elements && parallel)
    return std::make_unique<ParallelElementBody>(model, *model.elements, threads);
  if (model.edges) return std::make_unique<EdgeBody>(model, *model.edges, threads);
  if (model.elements) return std::make_unique<ElementBody>(model, *model.elements, threads);
  if (scene.time.integrator == IntegratorKind::implicit) {
    require_few_general_constraints(scene);
    return std::make_unique<ShiftedBody>(model, scene.time.baumgarte);
  }
  return std::make_unique<AssembledBody>(model, scene.time.baumgarte);
}

}  // namespace rheo
