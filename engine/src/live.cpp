#include "rheo/live.hpp"

#include <cassert>
#include <cmath>

#include "hands.hpp"

namespace rheo {
namespace {

// What is known of the scene's own eigenvalues does not hold for what hands hold besides.
SimulationOptions options_of(const LiveSettings& settings) {
  SimulationOptions options = settings.simulation;
  if (options.nearness == Nearness::near) options.nearness = Nearness::range;
  return options;
}

}  // namespace

// The hands look at the simulation's own scene, which does not move.
Live::Live(Scene scene, LiveSettings settings)
    : simulation_(std::make_unique<Simulation>(std::move(scene), options_of(settings))),
      rate_(settings.rate) {
  hands_ = std::make_unique<Hands>(simulation_->scene(), settings);
  simulation_->attach(*hands_);
}
Live::Live(Scene scene, LiveSettings settings, const SavedState& saved)
    : Live(std::move(scene), std::move(settings)) {
  simulation_->resume(saved);
  ticks_ = std::llround(saved.t * rate_);
}
Live::Live(Live&&) noexcept = default;
Live& Live::operator=(Live&&) noexcept = default;
Live::~Live() = default;

int Live::handle_count() const {
  return hands_->count();
}
bool Live::pick(int handle, std::span<const int> nodes, std::span<const Edge> edges) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->pick(handle, nodes, edges);
}
bool Live::push(int handle, Vec2 traction) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->push(handle, traction);
}
bool Live::press(int handle, Vec2 traction) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->press(handle, traction);
}
int Live::grab(int handle) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->grab(handle, time(), simulation_->v());
}
bool Live::drag(int handle, Vec2 displacement) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->drag(handle, displacement, nullptr);
}
bool Live::drag(int handle, Vec2 displacement, Vec2 velocity) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->drag(handle, displacement, &velocity);
}
bool Live::release(int handle) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->release(handle, time());
}
bool Live::is_grabbed(int handle) const {
  return hands_->is_grabbed(handle);
}
Vec2 Live::traction(int handle) const {
  return hands_->traction(handle);
}

std::optional<Divergence> Live::tick() {
  if (diverged_) return diverged_;
  const double begin = time();
  const double end = static_cast<double>(ticks_ + 1) / rate_;
  if (hands_->begin_tick(begin, end)) simulation_->hands_changed();
  diverged_ = simulation_->advance(end);
  if (!diverged_) ++ticks_;
  return diverged_;
}

double Live::time() const {
  return simulation_->time();
}
std::int64_t Live::ticks() const {
  return ticks_;
}
HandReading Live::read(int handle) {
  assert(handle >= 0 && handle < handle_count());
  return hands_->read(handle, simulation_->u(), simulation_->reaction_at(hands_->held(handle)));
}
std::span<const double> Live::reaction() {
  return simulation_->reaction();
}
ProbeReading Live::read(const Probe& probe) {
  return simulation_->read(probe);
}
const Simulation& Live::simulation() const {
  return *simulation_;
}

Scene Live::session() const {
  Scene scene = simulation_->scene();
  hands_->append_to(scene, time());
  if (ticks_ > 0) scene.time.duration = time();
  PictureSettings& picture = scene.picture;  // shapes of a time that the session has not come to
  while (!picture.sheet.empty() && picture.sheet.back() > scene.time.duration) picture.sheet.pop_back();
  if (!picture.captions.empty()) picture.captions.resize(picture.sheet.size());
  scene.time.frame_rate = rate_;
  if (std::isfinite(simulation_->step_bound())) scene.time.step = simulation_->step_bound();
  return scene;
}
bool Live::session_is_complete() const {
  return hands_->record_is_complete();
}

}  // namespace rheo
