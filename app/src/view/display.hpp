// What the window shows of a moment: one whole state, copied out of the physics, never looked at by both.
//
// Units    SI
// Shapes   positions, velocities: n x 2, deformed; magnitudes: n
// Errors   none
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rheo/deformation.hpp"
#include "rheo/live.hpp"
#include "view/history.hpp"

namespace app::view {

enum class Hold { nothing, push, grab };

// Whether what was done since t = 0 can be saved as a scene.
enum class SessionState { nothing_yet, whole, parameters_changed, too_long };

struct HandDisplay {
  Hold hold = Hold::nothing;
  std::int64_t press = 0;  // the number that it was begun with
  std::vector<rheo::Edge> edges;
  rheo::Vec2 traction;      // on them now [Pa]
  rheo::Vec2 displacement;  // mean over their nodes [m]
  rheo::Vec2 force;         // of the hand on the body [N]
};

struct Display {
  std::shared_ptr<const rheo::Scene> scene;  // as it is run now
  std::int64_t body = 0;                     // another number, another mesh
  std::int64_t run = 0;                      // another number, begun again at 0 or with other parameters
  double t = 0.0;
  std::int64_t ticks = 0;

  std::vector<double> positions, velocities, w_lambda, w_mu, speed;
  std::vector<int> held;  // 2 node + axis
  std::vector<rheo::Simulation::ActiveTraction> tractions;
  HandDisplay hand;

  rheo::Energies energies;
  double energy_start = 0.0;  // their balance where the parameters of now began
  double w_lambda_norm = 0.0, w_mu_norm = 0.0;
  rheo::LinearityReport linearity;
  History history;

  std::int64_t steps = 0;     // since the program began
  double busy_seconds = 0.0;  // of the physics, since the program began
  double stable_step = 0.0, step_bound = 0.0, largest_step = 0.0;
  std::string kernel;
  int threads = 1;

  bool running = false;
  bool resting = false;           // nothing moves and nothing acts: no steps
  bool diverged = false;          // no tick until it is set back
  double speed_wanted = 1.0;      // simulated seconds a second
  double real_time_factor = 1.0;  // what of it is reached, over the last second
  SessionState session = SessionState::nothing_yet;
  std::string message;  // the last one, empty: none
  std::int64_t message_number = 0;
};

// (kinetic + stored + dissipated - work) less what it was at the start. [J]
double drift_of(const Display& display);

}  // namespace app::view
