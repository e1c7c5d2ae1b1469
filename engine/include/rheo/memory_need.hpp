// Memory that a simulation of a scene takes, told before it is built.
//
// An estimate, about by how much the largest parts grow:
//
//   nodes          0.9 kB each with lumped mass, 2.8 kB where constraints are solved for, from assembled
//                  matrices, 2.7 kB with the consistent one, whose factors fill in (peak resident size of
//                  `rheo check` on a rectangle of 500 x 500 nodes; rheo_bench_memory); the implicit
//                  integrator's matrices 2.4 and 4.5 kB, and for each factor kept at most 135 log2(nodes)
//                  bytes a node (from 500 to 500,000 nodes: rectangles 52 to 107, disks 80 to 133)
//   branches       128 bytes for each beyond the first and each node of its material's; where materials meet
//   a
//                  node counts for each of them
//   constraints    40 bytes for each pair of general constraints that meet in a degree of freedom, with
//                  consistent mass for each pair (A^T M^-1 A)
//   events         a byte three times for each event and each fix and move: what is held when
//
// Units    bytes
// Not here what the fill of the constraints' factor adds: known when it is ordered, and refused there
#pragma once

#include <string>

#include "rheo/scene.hpp"

namespace rheo {

struct MemoryNeed {
  double nodes = 0.0;  // branches included
  double constraints = 0.0;
  double events = 0.0;

  double total() const { return nodes + constraints + events; }
};

MemoryNeed memory_need(const Scene& scene);

// Refuses a need beyond `limit` [bytes]; 0: what this machine has available. `also`: bytes for what the
// caller does beside it, `remedy`: what would make that smaller. Errors   Error::Kind::input: the estimate of
// what takes most, the limit, what to do
void require_memory(const Scene& scene, double limit, double also = 0.0, const std::string& remedy = {});

}  // namespace rheo
