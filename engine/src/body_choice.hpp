// Which kind of body carries a scene.
//
//   implicit                                                    assembled, with a factor
//   lumped mass, constraints all eliminated                     by edges; by elements where there are several
//                                                               materials, or where the processor has
//                                                               baseline instructions only and the branches
//                                                               are not combined (a fifth to a third faster)
//   else                                                        assembled
//
// Errors   Error::Kind::input: a kernel or an integrator that does not go with the scene
#pragma once

#include <memory>

#include "body.hpp"

namespace rheo {

// The fastest kernel that the scene's mass and constraints allow, unless one is asked for.
Assembly assembly_for(const Scene& scene, Kernel kernel, SimdLevel level = best_simd_level());

// `model` must outlive the body; assembled as assembly_for() says.
std::unique_ptr<Body> make_body(const Scene& scene, const Model& model, int threads);

}  // namespace rheo
