// How many rigid motions the constraints leave to a mesh: shifts and small turns of each of its pieces, and
// of several together.
//
// By the singular values of what is held in each of them: below 1e-14 of the largest nothing is held. What is
// hardly held, as by a tie of 1 and 1.0001, is held.
//
// Errors   none: -1, not known, of more than 30 pieces
#pragma once

#include "constraints.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

int rigid_motions(const Mesh& mesh, const ConstraintSolver& solver);

}  // namespace rheo
