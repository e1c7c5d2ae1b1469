// What hands did, as keys: enough to write it as moves and tractions of a scene.
//
// Shapes   flat lists, all memory taken at the beginning
// Errors   none: what finds no room makes the record incomplete
#pragma once

#include <span>
#include <vector>

#include "rheo/live.hpp"

namespace rheo {

// A grabbed node's own course on the way from its velocity v0 to the hand's (live.hpp), and whether it
// is on it at t.
bool approaches(double t, double from, double grab_time);
MoveKey with_approach(const MoveKey& hand, Vec2 v0, double from, double grab_time);

class HandRecord {
 public:
  explicit HandRecord(std::size_t capacity);

  // What a hold holds: a node in one or both axes, with its velocity before.
  struct Taken {
    int node = 0;
    Axis axis = Axis::both;
    Vec2 v0;
  };

  // Number of the new episode, or none.
  static constexpr int none = -1;
  int begin_hold(double t);
  void take(int episode, const Taken& taken);
  int begin_push(double t, std::span<const Edge> edges, Vec2 traction);
  // Keys of one episode rise; one at a time that is there already is the same and left out.
  void add_key(int episode, const MoveKey& key);
  void end(int episode, double t);

  bool complete() const { return complete_; }
  // Adds what began before t; what goes on is let go at t.
  void append_to(Scene& scene, double t, double grab_time) const;

 private:
  struct Episode {
    enum class Kind { hold, push } kind = Kind::hold;
    double from = 0.0, until = forever;
    double last_key = 0.0;
    std::size_t first = 0, last = 0;  // of taken_ or edges_
  };
  struct Key {
    int episode = 0;
    MoveKey key;  // a push's traction in u
  };

  int begin(const Episode& episode);
  template <class Item>
  bool add(std::vector<Item>& list, const Item& item);
  std::vector<MoveKey> keys_of(int episode) const;

  bool complete_ = true;
  std::vector<Episode> episodes_;
  std::vector<Key> keys_;
  std::vector<Taken> taken_;
  std::vector<Edge> edges_;
};

}  // namespace rheo
