// A body under one user's hand, tick by tick: push, grab, let go, other parameters, another scene.
//
// The hand follows what it is told by a critically damped course of third order, so that neither its place
// nor its speed nor its acceleration jumps however rarely and unevenly a cursor is seen: a cubic spline with
// knots at the ticks, whose x''' is chosen at each such that the distance to a target at rest has the pole d
// = exp(-1.5 tick / follow) three times.
//
// An automatic step is a quarter of the stable one as everywhere; where that would be too slow for real time,
// 0.9 of it.
//
// Units    SI
// Errors   Error::Kind::input from the constructor; later a message, and what was goes on
// Threads  one at a time
// Not here clocks (physics.hpp), pictures
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/display.hpp"

namespace app::view {

struct CoreSettings {
  double rate = 1000.0;  // ticks a second of simulated time
  double follow = 0.02;  // [s] of the user's time
  rheo::SimulationOptions simulation;
};

inline constexpr int most_picked_edges = 64;

class Core {
 public:
  Core(rheo::Scene scene, const CoreSettings& settings);

  const rheo::Scene& scene() const { return *scene_; }
  double rate() const { return settings_.rate; }

  // Takes hold of edges; lets go of what it had. False: nothing there can be held. press: shown with it, so
  // that whoever asked knows that this is it.
  bool begin(Hold hold, const std::vector<rheo::Edge>& edges, std::int64_t press = 0);
  // Where to: a traction [Pa] or a displacement since the grab [m]. pace: simulated seconds a second of the
  // user's.
  void aim(rheo::Vec2 target, double pace);
  void let_go();

  // False: refused, message() says why and all goes on as it was.
  bool change(rheo::Scene edited);  // the same mesh
  bool load(rheo::Scene other);
  void reset();  // to t = 0, with the parameters of now

  // Whether all is well. After a divergence message() says so, and only reset, change or load go on.
  bool tick();
  // Nothing acts, nothing will act, and for half a second nothing moved that could be seen.
  bool still() const { return still_; }

  // Neither this nor tick() allocates anything once it has done so for a body, its display and its hand.
  void show(Display& display);
  const std::string& message() const { return message_; }
  void say(std::string message);

  // What was done since the last reset, as a scene; nullopt with a message where it cannot be said by one.
  std::optional<rheo::Scene> session();
  SessionState session_state() const;

  const rheo::Live& live() const { return *live_; }

 private:
  static rheo::LiveSettings live_settings(const CoreSettings& settings);
  void start(rheo::Scene scene, const rheo::SavedState* saved);
  void begin_again();
  void watch_for_rest();
  void tell_of_accuracy(double accuracy);
  void refuse(const std::string& why);
  void follow_target();
  void sample();

  CoreSettings settings_;
  std::shared_ptr<const rheo::Scene> scene_;
  std::unique_ptr<rheo::Live> live_;
  std::int64_t body_ = 0, run_ = 0;
  bool whole_ = true;  // the session is all of the run
  bool diverged_ = false;
  std::int64_t steps_before_ = 0;  // of earlier simulations

  Hold hold_ = Hold::nothing;
  std::int64_t press_ = 0;
  int handle_ = 0;
  std::vector<rheo::Edge> edges_;
  rheo::Vec2 target_, at_, velocity_, acceleration_;
  double follow_ = 0.02;  // [s] of simulated time

  History history_;
  double energy_start_ = 0.0;  // kinetic + stored + dissipated - work
  double last_event_ = 0.0, size_ = 1.0;
  bool still_ = false;
  double still_since_ = 0.0;
  std::vector<double> looked_at_u_, looked_at_w_lambda_, looked_at_w_mu_;
  double looked_at_ = 0.0, largest_w_ = 0.0;

  std::string message_;
  std::int64_t message_number_ = 0;
};

}  // namespace app::view
