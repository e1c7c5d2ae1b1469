#include "hand_record.hpp"

#include <algorithm>

namespace rheo {

bool approaches(double t, double from, double grab_time) {
  return t - from < grab_time * (1.0 - 1e-9);  // a remainder of rounding would be a jump of its own
}

MoveKey with_approach(const MoveKey& hand, Vec2 v0, double from, double grab_time) {
  if (!approaches(hand.t, from, grab_time)) return hand;
  const double s = hand.t - from;
  const double left = 1.0 - s / grab_time;
  const double place = s * left * left * left;
  const double speed = left * left * (1.0 - 4.0 * s / grab_time);
  return {hand.t,
          {hand.u.x + v0.x * place, hand.u.y + v0.y * place},
          {hand.v.x + v0.x * speed, hand.v.y + v0.y * speed}};
}

HandRecord::HandRecord(std::size_t capacity) : complete_(capacity > 0) {
  episodes_.reserve(capacity);
  keys_.reserve(capacity);
  taken_.reserve(capacity);
  edges_.reserve(capacity);
}

template <class Item>
bool HandRecord::add(std::vector<Item>& list, const Item& item) {
  complete_ = complete_ && list.size() < list.capacity();
  if (complete_) list.push_back(item);
  return complete_;
}

int HandRecord::begin(const Episode& episode) {
  if (!add(episodes_, episode)) return none;
  return static_cast<int>(episodes_.size()) - 1;
}

int HandRecord::begin_hold(double t) {
  const int episode = begin({Episode::Kind::hold, t, forever, -1.0, taken_.size(), taken_.size()});
  add_key(episode, {t, {}, {}});
  return episode;
}

void HandRecord::take(int episode, const Taken& taken) {
  if (episode != none && add(taken_, taken)) episodes_[episode].last = taken_.size();
}

int HandRecord::begin_push(double t, std::span<const Edge> edges, Vec2 traction) {
  const std::size_t first = edges_.size();
  for (const Edge& edge : edges) add(edges_, edge);
  const int episode = begin({Episode::Kind::push, t, forever, -1.0, first, edges_.size()});
  add_key(episode, {t, traction, {}});
  return episode;
}

void HandRecord::add_key(int episode, const MoveKey& key) {
  if (episode == none || episodes_[episode].last_key == key.t) return;
  if (add(keys_, Key{episode, key})) episodes_[episode].last_key = key.t;
}

void HandRecord::end(int episode, double t) {
  if (episode != none) episodes_[episode].until = t;
}

std::vector<MoveKey> HandRecord::keys_of(int episode) const {
  std::vector<MoveKey> keys;
  for (const Key& k : keys_) {
    if (k.episode == episode) keys.push_back(k.key);
  }
  return keys;
}

void HandRecord::append_to(Scene& scene, double t, double grab_time) const {
  for (std::size_t i = 0; i < episodes_.size(); ++i) {
    const Episode& episode = episodes_[i];
    // What goes on goes on: it is there in the last output too.
    const Window window{episode.from, episode.until};
    if (!(window.from < std::min(window.until, t))) continue;
    const std::vector<MoveKey> keys = keys_of(static_cast<int>(i));
    if (episode.kind == Episode::Kind::push) {
      Traction traction;
      traction.edges.assign(edges_.begin() + static_cast<std::ptrdiff_t>(episode.first),
                            edges_.begin() + static_cast<std::ptrdiff_t>(episode.last));
      for (const MoveKey& key : keys) traction.keys.push_back({key.t, key.u});
      traction.window = window;
      scene.tractions.push_back(std::move(traction));
      continue;
    }
    // One move for all nodes that came with the same velocity: for a body at rest one for all.
    std::vector<Taken> rest(taken_.begin() + static_cast<std::ptrdiff_t>(episode.first),
                            taken_.begin() + static_cast<std::ptrdiff_t>(episode.last));
    while (!rest.empty()) {
      const Taken like = rest.front();
      Move move;
      move.axis = like.axis;
      move.window = window;
      move.profile = Profile::hermite;
      for (const MoveKey& key : keys)
        move.keys.push_back(with_approach(key, like.v0, episode.from, grab_time));
      std::erase_if(rest, [&](const Taken& other) {
        if (other.axis != like.axis || !(other.v0 == like.v0)) return false;
        move.nodes.push_back(other.node);
        return true;
      });
      scene.moves.push_back(std::move(move));
    }
  }
}

}  // namespace rheo
