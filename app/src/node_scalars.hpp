// What is coloured, at every node: for the recorder of a run and for the window alike.
//
// Units    w [Pa m], speed [m/s]
// Shapes   out: n
// Errors   none
#pragma once

#include <span>
#include <string>

#include "rheo/simulation.hpp"

namespace app {

// branch: 0: all of w but the elastic part; 1, 2, ...: one Maxwell branch alone.
void find_scalars(const rheo::Simulation& simulation, rheo::ColorBy color, int branch, std::span<double> out);

struct ScalarText {
  std::string
      name;  // empty: nothing is coloured; with the branch's number where it is one alone: "|w_mu| (2)"
  std::string unit;
};
ScalarText scalar_text(rheo::ColorBy color, int branch);

}  // namespace app
