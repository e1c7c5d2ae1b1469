// Which kind of body carries a scene.
//
//   implicit                                                    assembled, with a factor
//   lumped mass, constraints all eliminated                     by edges (unless another kernel is asked for)
//   else                                                        assembled
//
// Errors   Error::Kind::input: a kernel or an integrator that does not go with the scene
#pragma once

#include <memory>

#include "body.hpp"

namespace rheo {

// The fastest kernel that the scene's mass and constraints allow, unless one is asked for.
Assembly assembly_for(const Scene& scene, Kernel kernel);

// `model` must outlive the body; assembled as assembly_for() says.
std::unique_ptr<Body> make_body(const Scene& scene, const Model& model, int threads);

}  // namespace rheo
