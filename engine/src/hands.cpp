#include "hands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {
namespace {

bool usable(Vec2 value) {
  return within_size(value.x) && within_size(value.y);
}

bool is_node(int node, const Mesh& mesh) {
  return node >= 0 && node < mesh.node_count();
}

bool is_zero(Vec2 value) {
  return value == Vec2{};
}

[[noreturn]] void refuse(const std::string& text) {
  throw Error(Error::Kind::input, text);
}

void validate(const LiveSettings& settings, const Scene& scene) {
  if (!of_usable_size(settings.rate))
    refuse(fmt::format("rate = {}: a finite number > 0 (ticks per second) is needed", settings.rate));
  if (!(settings.grab_time >= 0.0) || !within_size(settings.grab_time))
    refuse(fmt::format("grab_time = {}: a finite number >= 0 (s) is needed", settings.grab_time));
  if (settings.record < 0) refuse(fmt::format("record = {}: 0 or more is needed", settings.record));
  for (const Handle& handle : settings.handles) {
    const std::string where = fmt::format("handle \"{}\":", handle.name);
    const auto check = [&](int node) {
      if (!is_node(node, scene.mesh))
        refuse(fmt::format("{} node {}: the nodes are numbered 0 to {}", where, node,
                           scene.mesh.node_count() - 1));
    };
    for (const int node : handle.nodes) check(node);
    for (const Edge& edge : handle.edges) {
      for (const int node : edge) check(node);
      if (edge[0] == edge[1]) refuse(fmt::format("{0} edge ({1}, {1}): two different nodes", where, edge[0]));
    }
    if (handle.capacity < 0) refuse(fmt::format("{} capacity = {}: 0 or more", where, handle.capacity));
  }
}

}  // namespace

Hands::Hands(const Scene& scene, const LiveSettings& settings)
    : scene_(scene), grab_time_(0.0), record_(static_cast<std::size_t>(std::max(0, settings.record))) {
  validate(settings, scene);
  grab_time_ = std::max(settings.grab_time, 1.0 / settings.rate);
  const std::size_t dofs = 2 * scene.mesh.points.size();
  taken_.assign(dofs, 0);
  free_from_.assign(dofs, 0.0);
  const std::vector<Holder> holders = holders_of(scene);
  scene_owners_ = static_cast<int>(holders.size());
  const auto bind = [&](int node, Axis axis, double until) {
    if (axis != Axis::y) free_from_[2 * node] = std::max(free_from_[2 * node], until);
    if (axis != Axis::x) free_from_[2 * node + 1] = std::max(free_from_[2 * node + 1], until);
  };
  for (const Holder& holder : holders) {
    for (const int node : *holder.nodes) bind(node, holder.axis, holder.window.until);
  }
  for (const Constraint& constraint : scene.constraints) {
    for (const ConstraintTerm& term : constraint.terms) bind(term.node, term.axis, forever);
  }
  for (const Handle& handle : settings.handles) {
    Hand hand;
    hand.axis = handle.axis;
    const auto capacity = static_cast<std::size_t>(handle.capacity);
    hand.edge_capacity = std::max(capacity, handle.edges.size());
    hand.node_capacity = std::max(capacity, handle.nodes.size()) + 2 * hand.edge_capacity;
    hand.first_owner = owners_;
    owners_ += hand.node_capacity;
    hand.nodes.reserve(hand.node_capacity);
    hand.edges.reserve(hand.edge_capacity);
    hand.pattern.reserve(2 * hand.edge_capacity);
    hand.held.reserve(2 * hand.node_capacity);
    hand.v0.reserve(hand.node_capacity);
    set(hand, handle.nodes, handle.edges);
    hands_.push_back(std::move(hand));
  }
  pushing_.reserve(hands_.size());
}

void Hands::set(Hand& hand, std::span<const int> nodes, std::span<const Edge> edges) const {
  hand.edges.assign(edges.begin(), edges.end());
  hand.nodes.assign(nodes.begin(), nodes.end());
  for (const Edge& edge : edges) hand.nodes.insert(hand.nodes.end(), edge.begin(), edge.end());
  std::sort(hand.nodes.begin(), hand.nodes.end());
  hand.nodes.erase(std::unique(hand.nodes.begin(), hand.nodes.end()), hand.nodes.end());
  load_pattern(scene_.mesh, edges, hand.pattern);
}

bool Hands::pick(int handle, std::span<const int> nodes, std::span<const Edge> edges) {
  Hand& hand = hands_[handle];
  if (hand.grabbed || hand.pushing || !is_zero(hand.next_traction)) return false;
  if (edges.size() > hand.edge_capacity || nodes.size() + 2 * edges.size() > hand.node_capacity) return false;
  const auto known = [&](int node) { return is_node(node, scene_.mesh); };
  if (!std::all_of(nodes.begin(), nodes.end(), known)) return false;
  if (!std::all_of(edges.begin(), edges.end(),
                   [&](const Edge& edge) { return known(edge[0]) && known(edge[1]) && edge[0] != edge[1]; }))
    return false;
  set(hand, nodes, edges);
  return true;
}

bool Hands::push(int handle, Vec2 traction) {
  if (!usable(traction) || hands_[handle].edges.empty()) return false;
  hands_[handle].next_traction = traction;
  return true;
}

bool Hands::press(int handle, Vec2 traction) {
  Hand& hand = hands_[handle];
  if (hand.pushing || !is_zero(hand.traction_b.p) || !push(handle, traction)) return false;
  hand.traction_b.p = traction;
  hand.pressed = !is_zero(traction);
  return true;
}

int Hands::grab(int handle, double t, std::span<const double> v) {
  Hand& hand = hands_[handle];
  if (hand.grabbed) return static_cast<int>(hand.held.size());
  if (!can_hold()) return 0;
  hand.held.clear();
  hand.v0.clear();
  hand.approaching = false;
  for (std::size_t k = 0; k < hand.nodes.size(); ++k) {
    const int node = hand.nodes[k];
    const int owner = scene_owners_ + static_cast<int>(hand.first_owner + k);
    Vec2& v0 = hand.v0.emplace_back();
    for (int axis = 0; axis < 2; ++axis) {
      const int dof = 2 * node + axis;
      if (hand.axis == (axis == 0 ? Axis::y : Axis::x)) continue;
      if (taken_[dof] != 0 || free_from_[dof] > t) continue;
      taken_[dof] = 1;
      hand.held.push_back({dof, owner});
      (axis == 0 ? v0.x : v0.y) = v[dof];
    }
    hand.approaching = hand.approaching || !is_zero(v0);
  }
  if (hand.held.empty()) return 0;
  hand.grabbed = hand.changed = true;
  hand.in_motion = false;
  hand.from = t;
  hand.a = hand.b = {t, {}, {}};
  hand.target = {};
  hand.velocity_given = false;
  hand.hold_episode = record_.begin_hold(t);
  for (std::size_t i = 0; i < hand.held.size(); ++i) {
    const int node = hand.held[i].dof / 2;
    HandRecord::Taken taken{
        node, hand.held[i].dof % 2 == 0 ? Axis::x : Axis::y,
        hand.v0[static_cast<std::size_t>(hand.held[i].owner - scene_owners_) - hand.first_owner]};
    if (i + 1 < hand.held.size() && hand.held[i + 1].dof / 2 == node) {
      taken.axis = Axis::both;
      ++i;
    }
    record_.take(hand.hold_episode, taken);
  }
  return static_cast<int>(hand.held.size());
}

bool Hands::drag(int handle, Vec2 displacement, const Vec2* velocity) {
  Hand& hand = hands_[handle];
  if (!hand.grabbed || !usable(displacement) || (velocity != nullptr && !usable(*velocity))) return false;
  hand.target = displacement;
  hand.velocity_given = velocity != nullptr;
  if (velocity != nullptr) hand.velocity = *velocity;
  return true;
}

bool Hands::release(int handle, double t) {
  Hand& hand = hands_[handle];
  if (!hand.grabbed) return false;
  for (const HeldDof& h : hand.held) taken_[h.dof] = 0;
  hand.held.clear();
  hand.grabbed = hand.in_motion = false;
  hand.changed = true;
  record_.end(hand.hold_episode, t);
  return true;
}

HandReading Hands::read(int handle, std::span<const double> u, std::span<const double> reaction) const {
  const Hand& hand = hands_[handle];
  HandReading reading;
  if (hand.nodes.empty()) return reading;
  for (const int node : hand.nodes) {
    reading.displacement.x += u[2 * node];
    reading.displacement.y += u[2 * node + 1];
  }
  reading.displacement.x /= static_cast<double>(hand.nodes.size());
  reading.displacement.y /= static_cast<double>(hand.nodes.size());
  for (const HeldDof& h : hand.held) (h.dof % 2 == 0 ? reading.force.x : reading.force.y) += reaction[h.dof];
  for (const auto& [node, weight] : hand.pattern) {
    reading.force.x += weight * hand.traction_b.p.x;
    reading.force.y += weight * hand.traction_b.p.y;
  }
  return reading;
}

bool Hands::begin_tick(double t0, double t1) {
  bool differs = false;
  for (int k = 0; k < count(); ++k) {
    differs = begin_hold(hands_[k], t0, t1) || differs;
    differs = begin_push(k, t0, t1) || differs;
  }
  return differs;
}

bool Hands::begin_hold(Hand& hand, double t0, double t1) {
  const bool differed = hand.changed || hand.in_motion;
  hand.changed = false;
  if (!hand.grabbed) return differed;
  hand.a = {t0, hand.b.u, hand.b.v};
  Vec2 velocity{(hand.target.x - hand.a.u.x) / (t1 - t0), (hand.target.y - hand.a.u.y) / (t1 - t0)};
  if (hand.velocity_given) velocity = hand.velocity;
  hand.velocity_given = false;
  hand.b = {t1, hand.target, velocity};
  hand.in_motion = !(hand.a.u == hand.b.u) || !is_zero(hand.a.v) || !is_zero(hand.b.v) ||
                   (hand.approaching && approaches(t0, hand.from, grab_time_));
  if (hand.in_motion) {
    record_.add_key(hand.hold_episode, hand.a);
    record_.add_key(hand.hold_episode, hand.b);
  }
  return differed || hand.in_motion;
}

bool Hands::begin_push(int handle, double t0, double t1) {
  Hand& hand = hands_[handle];
  const auto key = [](const TractionKey& k) { return MoveKey{k.t, k.p, {}}; };
  const bool differed = !(hand.traction_a.p == hand.traction_b.p);
  hand.traction_a = {t0, hand.traction_b.p};
  hand.traction_b = {t1, hand.next_traction};
  const bool changes = !(hand.traction_a.p == hand.traction_b.p);
  if ((changes || hand.pressed) && !hand.pushing) {
    hand.pushing = true;
    pushing_.push_back(handle);
    hand.push_episode = record_.begin_push(t0, hand.edges, hand.traction_a.p);
  }
  const bool jumps = std::exchange(hand.pressed, false);
  if (changes) {
    record_.add_key(hand.push_episode, key(hand.traction_a));
    record_.add_key(hand.push_episode, key(hand.traction_b));
  }
  if (hand.pushing && is_zero(hand.traction_a.p) && is_zero(hand.traction_b.p)) {
    hand.pushing = false;
    pushing_.erase(std::find(pushing_.begin(), pushing_.end(), handle));
    record_.end(hand.push_episode, t0);
  }
  return differed || changes || jumps;
}

bool Hands::takes_now(int owner, double t) const {
  if (owner < scene_owners_) return false;
  const auto own = static_cast<std::size_t>(owner - scene_owners_);
  return std::any_of(hands_.begin(), hands_.end(), [&](const Hand& hand) {
    return hand.grabbed && own >= hand.first_owner && own < hand.first_owner + hand.node_capacity &&
           hand.from == t;
  });
}

bool Hands::add_to(Interval& interval) {
  interval.course.resize(static_cast<std::size_t>(scene_owners_) + owners_);
  bool any = false;
  for (const Hand& hand : hands_) {
    if (!hand.grabbed) continue;
    any = true;
    interval.moving = interval.moving || hand.in_motion;
    for (std::size_t k = 0; k < hand.nodes.size(); ++k) {
      const auto key = [&](const MoveKey& at) {
        return with_approach(at, hand.v0[k], hand.from, grab_time_);
      };
      interval.course[static_cast<std::size_t>(scene_owners_) + hand.first_owner + k] =
          hermite_piece(key(hand.a), key(hand.b));
    }
    interval.held.insert(interval.held.end(), hand.held.begin(), hand.held.end());
  }
  if (any) {
    std::sort(interval.held.begin(), interval.held.end(),
              [](const HeldDof& a, const HeldDof& b) { return a.dof < b.dof; });
    interval.eliminated = interval.held;
  }
  for (const int k : pushing_) {
    const Hand& hand = hands_[k];
    add_traction(interval, hand.pattern, linear_piece(hand.traction_a, hand.traction_b));
  }
  return any;
}

void Hands::prepare(Schedule& schedule) const {
  if (!can_hold()) return;
  if (schedule.holding_is_free()) {
    schedule.solver_holding(0, {});
    return;
  }
  for (std::size_t i = 0; i < schedule.interval_count(); ++i) {
    const Interval interval = schedule.interval(i);
    for (const Hand& hand : hands_) {
      std::vector<HeldDof> held = interval.held;
      for (const int node : hand.nodes) {
        for (int axis = 0; axis < 2; ++axis) {
          const int dof = 2 * node + axis;
          if (hand.axis == (axis == 0 ? Axis::y : Axis::x)) continue;
          // As grab() would choose at any time of this interval.
          if (free_from_[dof] <= schedule.begin(i)) held.push_back({dof, scene_owners_});
        }
      }
      std::sort(held.begin(), held.end(), [](const HeldDof& a, const HeldDof& b) { return a.dof < b.dof; });
      if (held.size() > interval.held.size()) schedule.solver_holding(i, held);
    }
  }
}

}  // namespace rheo
