#include "view/core.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "node_scalars.hpp"
#include "rheo/error.hpp"

namespace app::view {
namespace {

constexpr int handle_count = 4;        // a hand that lets go takes a tick until it is idle
constexpr int record_room = 400000;    // keys of a session: minutes of dragging
constexpr double sample_every = 0.01;  // [s] of the plots, at first
constexpr double look_every = 0.1;     // [s]
constexpr double rest_after = 0.5;     // [s]
// What is slower than this cannot be seen: a colour step is 4e-3 of the largest w, a pixel 1e-3 of the size.
constexpr double still_place = 1e-6;  // of the body's size, in look_every
constexpr double still_w = 3e-5;      // of the largest w, likewise
constexpr double most_load = 0.25;    // of a processor, beside which there is the drawing
constexpr double quick_share = 0.9;   // of the stable step, where that is more

double size_of(const rheo::Mesh& mesh) {
  double low_x = rheo::forever, low_y = rheo::forever, high_x = -rheo::forever, high_y = -rheo::forever;
  for (const rheo::Vec2& p : mesh.points) {
    low_x = std::min(low_x, p.x);
    low_y = std::min(low_y, p.y);
    high_x = std::max(high_x, p.x);
    high_y = std::max(high_y, p.y);
  }
  return std::hypot(high_x - low_x, high_y - low_y);
}

// The last time at which the scene itself changes something.
double last_event_of(const rheo::Scene& scene) {
  double last = 0.0;
  const auto see = [&](const rheo::Window& window) {
    last = std::max(last, window.from);
    if (std::isfinite(window.until)) last = std::max(last, window.until);
  };
  for (const rheo::Fix& fix : scene.fixes) see(fix.window);
  for (const rheo::Move& move : scene.moves) {
    see(move.window);
    last = std::max(last, move.keys.back().t);
  }
  for (const rheo::Traction& traction : scene.tractions) {
    see(traction.window);
    last = std::max(last, traction.keys.back().t);
  }
  return last;
}

double norm(std::span<const double> x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}

double largest_change(std::span<const double> now, std::vector<double>& before) {
  double largest = before.size() == now.size() ? 0.0 : rheo::forever;
  for (std::size_t i = 0; i < now.size() && i < before.size(); ++i)
    largest = std::max(largest, std::abs(now[i] - before[i]));
  before.assign(now.begin(), now.end());
  return largest;
}

void magnitudes(std::span<const double> field, std::vector<double>& out) {
  out.resize(field.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::sqrt(field[2 * i] * field[2 * i] + field[2 * i + 1] * field[2 * i + 1]);
}

// What the automatic step would take of a processor at the speed of real time, by a step's usual price.
double load_of(const rheo::Simulation& simulation, double rate) {
  constexpr double seconds_a_triangle = 15e-9;
  return std::max(rate, 1.0 / simulation.step_bound()) * simulation.scene().mesh.triangle_count() *
         seconds_a_triangle;
}

double balance_of(const rheo::Energies& e) {
  return e.kinetic + e.stored + e.dissipated - e.work;
}

// Settings that a run to its end has and a window does without.
rheo::Scene for_hands(rheo::Scene scene) {
  scene.time.accuracy = 0.0;
  if (scene.time.integrator == rheo::IntegratorKind::automatic)
    scene.time.integrator = rheo::IntegratorKind::rk4;
  return scene;
}

}  // namespace

double drift_of(const Display& display) {
  return balance_of(display.energies) - display.energy_start;
}

Core::Core(rheo::Scene scene, const CoreSettings& settings) : settings_(settings) {
  const double accuracy = scene.time.accuracy;
  start(for_hands(std::move(scene)), nullptr);
  begin_again();
  tell_of_accuracy(accuracy);
}

// What a hand will do cannot be known, and so no step be chosen for an error.
void Core::tell_of_accuracy(double accuracy) {
  if (accuracy > 0.0)
    say(fmt::format(
        "accuracy = {:g} is for rheo run, render and bench; here {} takes steps of at most {:.3g} s",
        accuracy, scene_->time.integrator == rheo::IntegratorKind::rk4 ? "rk4" : "the integrator",
        live_->simulation().step_bound()));
}

// A refusal's advice for the command line is none in a window.
void Core::refuse(const std::string& why) {
  const std::size_t option = why.find(" (--allow-unstable)");
  const std::size_t advice = option == std::string::npos ? option : why.rfind(", or ", option);
  say(why.substr(0, advice));
}

rheo::LiveSettings Core::live_settings(const CoreSettings& settings) {
  rheo::LiveSettings live;
  live.rate = settings.rate;
  live.simulation = settings.simulation;
  live.record = record_room;
  live.handles.resize(handle_count);
  for (rheo::Handle& handle : live.handles) {
    handle.name = "hand";
    handle.capacity = most_picked_edges;
  }
  return live;
}

// The old one stays where the new one is refused.
void Core::start(rheo::Scene scene, const rheo::SavedState* saved) {
  rheo::validate(scene);
  auto shared = std::make_shared<const rheo::Scene>(std::move(scene));
  rheo::LiveSettings settings = live_settings(settings_);
  // Made anew at every change. (A given step may be beyond the safe bound and stable.)
  if (shared->time.step == 0.0) settings.simulation.nearness = rheo::Nearness::safe;
  const auto make = [&] {
    return saved ? std::make_unique<rheo::Live>(*shared, settings, *saved)
                 : std::make_unique<rheo::Live>(*shared, settings);
  };
  auto live = make();
  if (shared->time.step == 0.0 && load_of(live->simulation(), settings_.rate) > most_load) {
    settings.simulation.stable_share = quick_share;
    live = make();
  }
  if (live_) steps_before_ += live_->simulation().counters().steps;
  live_ = std::move(live);
  scene_ = std::move(shared);
  whole_ = saved == nullptr || saved->t == 0.0;
  ++run_;
}

void Core::begin_again() {
  hold_ = Hold::nothing;
  edges_.clear();
  diverged_ = false;
  still_ = false;
  still_since_ = looked_at_ = live_->time();
  looked_at_u_.clear();
  looked_at_w_lambda_.clear();
  looked_at_w_mu_.clear();
  largest_w_ = 0.0;
  last_event_ = last_event_of(*scene_);
  size_ = size_of(scene_->mesh);
  energy_start_ = balance_of(live_->simulation().energies());
  if (live_->ticks() > 0) return;
  history_.begin(std::llround(sample_every * settings_.rate));
  sample();
}

void Core::say(std::string message) {
  message_ = std::move(message);
  ++message_number_;
}

bool Core::begin(Hold hold, const std::vector<rheo::Edge>& edges, std::int64_t press) {
  let_go();
  if (hold == Hold::nothing || edges.empty() || diverged_) return false;
  if (hold == Hold::grab && scene_->time.constraints == rheo::ConstraintMethod::baumgarte) {
    say("constraints = \"baumgarte\" leaves no room for a grab, which holds exactly: push, or set \"auto\"");
    return false;
  }
  std::vector<rheo::Edge> few(edges.begin(),
                              edges.begin() + std::min<std::ptrdiff_t>(std::ssize(edges), most_picked_edges));
  for (int tried = 0; tried < handle_count; ++tried) {
    handle_ = (handle_ + 1) % handle_count;
    if (!live_->pick(handle_, {}, few)) continue;
    if (hold == Hold::grab && live_->grab(handle_) == 0) {
      say("nothing to grab: the scene holds these nodes itself");
      return false;
    }
    hold_ = hold;
    press_ = press;
    edges_ = std::move(few);
    target_ = at_ = velocity_ = acceleration_ = {};
    still_ = false;
    return true;
  }
  return false;
}

void Core::aim(rheo::Vec2 target, double pace) {
  if (!std::isfinite(target.x) || !std::isfinite(target.y)) return;
  target_ = target;
  follow_ = std::max(settings_.follow * pace, 1.0 / settings_.rate);
  still_ = false;
}

void Core::let_go() {
  if (hold_ == Hold::push) live_->push(handle_, {});
  if (hold_ == Hold::grab) live_->release(handle_);
  if (hold_ != Hold::nothing) {
    still_ = false;
    still_since_ = live_->time();
  }
  hold_ = Hold::nothing;
}

bool Core::change(rheo::Scene edited) {
  // Its books go on: what the energies jump by is work of the change. (Long steps keep none.)
  rheo::SavedState saved = live_->simulation().save();
  const rheo::Energies books = live_->simulation().energies();
  if (std::isfinite(books.work) && std::isfinite(books.dissipated)) saved.energies = books;
  const double balance = energy_start_;
  const bool goes_on = live_->ticks() > 0;
  const Hold hold = hold_;
  const std::vector<rheo::Edge> edges = edges_;
  try {
    start(for_hands(std::move(edited)), goes_on ? &saved : nullptr);
  } catch (const rheo::Error& error) {
    refuse(error.what());
    return false;
  }
  begin_again();
  if (goes_on && saved.energies && std::isfinite(balance)) energy_start_ = balance;
  // What the hand has it keeps: a push as it is; a grab begins anew from where it is.
  const rheo::Vec2 target = target_, at = at_, velocity = velocity_, acceleration = acceleration_;
  if (hold != Hold::nothing && begin(hold, edges, press_) && hold == Hold::push) {
    target_ = target;
    at_ = at;
    velocity_ = velocity;
    acceleration_ = acceleration;
    live_->press(handle_, at_);
  }
  return true;
}

bool Core::load(rheo::Scene other) {
  const double accuracy = other.time.accuracy;
  try {
    start(for_hands(std::move(other)), nullptr);
  } catch (const rheo::Error& error) {
    refuse(error.what());
    return false;
  }
  ++body_;
  begin_again();
  tell_of_accuracy(accuracy);
  return true;
}

void Core::reset() {
  start(*scene_, nullptr);
  begin_again();
}

void Core::follow_target() {
  // In units of a tick, v h and a h^2, the gains that put all three poles at d = 1 - r.
  const double h = 1.0 / settings_.rate, r = -std::expm1(-1.5 * h / follow_);
  const double k1 = r * r * r, k2 = 3.0 * r * r - k1, k3 = 3.0 * r - 1.5 * r * r + k1 / 3.0;
  const auto go = [&](double& x, double& v, double& a, double target, double close) {
    const double jerk = -(k1 * (x - target) + k2 * v * h + k3 * a * h * h);  // times h^3
    x += v * h + a * h * h / 2.0 + jerk / 6.0;
    v += a * h + jerk / (2.0 * h);
    a += jerk / (h * h);
    if (std::abs(x - target) <= close && std::abs(v) * follow_ <= close &&
        std::abs(a) * follow_ * follow_ <= close) {
      x = target;
      v = a = 0.0;
    }
  };
  const double close = 1e-9 * std::hypot(target_.x, target_.y);
  go(at_.x, velocity_.x, acceleration_.x, target_.x, close);
  go(at_.y, velocity_.y, acceleration_.y, target_.y, close);
}

bool Core::tick() {
  if (diverged_) return false;
  if (hold_ != Hold::nothing) {
    follow_target();
    if (hold_ == Hold::push) live_->push(handle_, at_);
    if (hold_ == Hold::grab) live_->drag(handle_, at_, velocity_);
  }
  if (const auto divergence = live_->tick()) {
    diverged_ = true;
    hold_ = Hold::nothing;
    say(fmt::format("diverged at t = {:.4g} s near node {}: the stable step is {:.3g} s; reset to go on",
                    divergence->t, divergence->node, divergence->stable_step));
    return false;
  }
  watch_for_rest();
  sample();
  return true;
}

void Core::sample() {
  if (!history_.is_due(live_->ticks())) return;
  const rheo::Simulation& simulation = live_->simulation();
  const rheo::Energies e = simulation.energies();
  rheo::HandReading hand;
  if (!edges_.empty()) hand = live_->read(handle_);
  if (hold_ == Hold::nothing) hand.force = {};
  history_.add({live_->time(), norm(simulation.w_lambda()), norm(simulation.w_mu()), e.kinetic, e.stored,
                e.dissipated, e.work, balance_of(e) - energy_start_,
                std::hypot(hand.displacement.x, hand.displacement.y),
                std::hypot(hand.force.x, hand.force.y)});
}

void Core::watch_for_rest() {
  const double t = live_->time();
  if (t - looked_at_ < look_every) return;
  looked_at_ = t;
  const rheo::Simulation& simulation = live_->simulation();
  const double moved = largest_change(simulation.u(), looked_at_u_);
  double w = 0.0;
  for (const double value : simulation.w_mu()) w = std::max(w, std::abs(value));
  for (const double value : simulation.w_lambda()) w = std::max(w, std::abs(value));
  largest_w_ = std::max(largest_w_, w);
  const double changed = std::max(largest_change(simulation.w_lambda(), looked_at_w_lambda_),
                                  largest_change(simulation.w_mu(), looked_at_w_mu_));
  const bool hand_moves = hold_ != Hold::nothing && !(at_ == target_);
  if (moved > still_place * size_ || changed > still_w * largest_w_ || hand_moves || t < last_event_)
    still_since_ = t;
  still_ = t - still_since_ >= rest_after;
}

void Core::show(Display& display) {
  const rheo::Simulation& simulation = live_->simulation();
  display.scene = scene_;
  display.body = body_;
  display.run = run_;
  display.t = live_->time();
  display.ticks = live_->ticks();
  const std::span<const double> u = simulation.u();
  display.positions.resize(u.size());
  for (std::size_t i = 0; i < u.size() / 2; ++i) {
    // In the precision in which a run keeps its frames: the same pixels.
    display.positions[2 * i] = scene_->mesh.points[i].x + static_cast<double>(static_cast<float>(u[2 * i]));
    display.positions[2 * i + 1] =
        scene_->mesh.points[i].y + static_cast<double>(static_cast<float>(u[2 * i + 1]));
  }
  display.velocities.assign(simulation.v().begin(), simulation.v().end());
  magnitudes(simulation.w_lambda(), display.w_lambda);
  magnitudes(simulation.w_mu(), display.w_mu);
  magnitudes(simulation.v(), display.speed);
  display.linearity = rheo::check_linearity(scene_->mesh, u);
  display.w_lambda_norm = norm(display.w_lambda);
  display.w_mu_norm = norm(display.w_mu);
  if (const int branch = scene_->picture.branch; branch > 0) {  // one alone is what is coloured
    find_scalars(simulation, rheo::ColorBy::w_lambda, branch, display.w_lambda);
    find_scalars(simulation, rheo::ColorBy::w_mu, branch, display.w_mu);
  }
  simulation.held_dofs(display.held);
  simulation.active_tractions(display.tractions);
  display.diverged = diverged_;
  display.hand.hold = hold_;
  display.hand.press = press_;
  display.hand.edges = edges_;
  display.hand.traction = display.hand.displacement = display.hand.force = {};
  if (!edges_.empty() && !diverged_) {
    const rheo::HandReading reading = live_->read(handle_);
    display.hand.displacement = reading.displacement;
    if (hold_ != Hold::nothing) display.hand.force = reading.force;
    if (hold_ == Hold::push) display.hand.traction = live_->traction(handle_);
  }
  display.history.follow(history_);
  display.energies = simulation.energies();
  display.energy_start = energy_start_;
  display.steps = steps_before_ + simulation.counters().steps;
  display.stable_step = simulation.stable_step();
  display.step_bound = simulation.step_bound();
  display.largest_step = simulation.largest_step();
  display.kernel = simulation.kernel();
  display.threads = simulation.threads();
  display.session = session_state();
  display.message = message_;
  display.message_number = message_number_;
}

SessionState Core::session_state() const {
  if (!whole_) return SessionState::parameters_changed;
  if (live_->ticks() == 0) return SessionState::nothing_yet;
  return live_->session_is_complete() ? SessionState::whole : SessionState::too_long;
}

std::optional<rheo::Scene> Core::session() {
  switch (session_state()) {
    case SessionState::whole:
      return live_->session();
    case SessionState::parameters_changed:
      say("a session begins at t = 0: parameters were changed on the way; reset, do it again and save");
      break;
    case SessionState::nothing_yet:
      say("nothing has happened yet: there is no session to save");
      break;
    case SessionState::too_long:
      say("the session is longer than what is remembered: reset, and save sooner");
      break;
  }
  return std::nullopt;
}

}  // namespace app::view
