// The hands of a Live: what each of them holds and pushes, and their part of an interval.
//
// A hand's courses are pieces of a hermite move and of a traction with keys from the beginning of a tick to
// its end. It takes only degrees of freedom that the scene does not hold from now on and no [[constraint]]
// binds: no conflict can arise later.
//
// Shapes   owners (Interval): one a node that a handle may have, after the scene's holders
// Errors   the constructor: Error::Kind::input; nothing else
#pragma once

#include <span>
#include <vector>

#include "hand_record.hpp"
#include "rheo/live.hpp"
#include "schedule.hpp"

namespace rheo {

class Hands {
 public:
  // `scene` must outlive this.
  Hands(const Scene& scene, const LiveSettings& settings);

  // As in live.hpp; v: n x 2, t: now.
  int count() const { return static_cast<int>(hands_.size()); }
  bool pick(int handle, std::span<const int> nodes, std::span<const Edge> edges);
  bool push(int handle, Vec2 traction);
  bool press(int handle, Vec2 traction);
  int grab(int handle, double t, std::span<const double> v);
  bool drag(int handle, Vec2 displacement, const Vec2* velocity);
  bool release(int handle, double t);
  bool is_grabbed(int handle) const { return hands_[handle].grabbed; }
  Vec2 traction(int handle) const { return hands_[handle].traction_b.p; }
  std::span<const HeldDof> held(int handle) const { return hands_[handle].held; }
  HandReading read(int handle, std::span<const double> u, std::span<const double> reaction) const;

  // Targets become courses from t0 to t1. Whether anything differs from the tick before.
  bool begin_tick(double t0, double t1);

  std::size_t owner_count() const { return owners_; }
  // Whether this owner's hold begins at t.
  bool takes_now(int owner, double t) const;
  // Adds holds and loads to the scene's; whether anything is held.
  bool add_to(Interval& interval);
  // Factors for the handles as they are, each alone.
  void prepare(Schedule& schedule) const;

  void append_to(Scene& scene, double t) const { record_.append_to(scene, t, grab_time_); }
  bool record_is_complete() const { return record_.complete(); }

 private:
  struct Hand {
    Axis axis = Axis::both;
    std::size_t node_capacity = 0, edge_capacity = 0;
    std::size_t first_owner = 0;  // among the hands'
    std::vector<int> nodes;       // rising, the edges' too
    std::vector<Edge> edges;
    LoadPattern pattern;

    // Hold: courses from a to b in this tick.
    bool grabbed = false;
    bool changed = false;      // grabbed or let go since the last tick
    bool in_motion = false;    // in this tick
    bool approaching = false;  // some node came with a velocity
    double from = 0.0;
    std::vector<HeldDof> held;  // owners among all
    std::vector<Vec2> v0;       // by node
    MoveKey a, b;
    Vec2 target, velocity;
    bool velocity_given = false;
    int hold_episode = HandRecord::none;

    // Push.
    TractionKey traction_a, traction_b;
    Vec2 next_traction;
    bool pressed = false;  // pushed at once since the last tick
    bool pushing = false;
    int push_episode = HandRecord::none;
  };

  // A hold is exact, and so none where the scene wants Baumgarte's for all.
  bool can_hold() const { return scene_.time.constraints != ConstraintMethod::baumgarte; }
  void set(Hand& hand, std::span<const int> nodes, std::span<const Edge> edges) const;
  bool begin_hold(Hand& hand, double t0, double t1);
  bool begin_push(int handle, double t0, double t1);

  const Scene& scene_;
  double grab_time_ = 0.0;
  int scene_owners_ = 0;
  std::size_t owners_ = 0;
  std::vector<double> free_from_;  // by degree of freedom: from when on the scene leaves it alone
  std::vector<char> taken_;        // by a hand
  std::vector<Hand> hands_;
  std::vector<int> pushing_;  // in the order in which they began, which is that of the record
  HandRecord record_;
};

}  // namespace rheo
