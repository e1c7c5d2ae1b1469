#include "recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "node_scalars.hpp"
#include "rheo/simulation.hpp"

namespace app {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<double> flat(const std::vector<rheo::Vec2>& points) {
  std::vector<double> out;
  out.reserve(2 * points.size());
  for (const rheo::Vec2& point : points) out.insert(out.end(), {point.x, point.y});
  return out;
}

// Numbers of a record: displacements and, where something is coloured, the scalar.
std::size_t record_length(const rheo::Scene& scene) {
  return scene.mesh.points.size() * (scene.picture.color == rheo::ColorBy::none ? 2 : 3);
}

}  // namespace

Recorder::Recorder(const rheo::Scene& scene, const std::filesystem::path& folder, KeptOutputs kept)
    : color_(scene.picture.color),
      branch_(scene.picture.branch),
      rest_(flat(scene.mesh.points)),
      boundary_nodes_(rheo::nodes_of(scene.mesh.edge_groups.at("boundary"))),
      kept_(std::move(kept)),
      store_(folder, record_length(scene), kept_.count()),
      record_(record_length(scene)),
      bounds_{infinite, infinite, -infinite, -infinite},
      range_{infinite, -infinite} {
  for (const int node : boundary_nodes_) {
    const auto i = static_cast<std::size_t>(node);
    include(rest_[2 * i], rest_[2 * i + 1]);
  }
}

void Recorder::record(rheo::Simulation& simulation, std::int64_t k) {
  const std::span<const double> u = simulation.u();
  for (std::size_t i = 0; i < u.size(); ++i) record_[i] = static_cast<float>(u[i]);
  for (const int node : boundary_nodes_) {
    const auto i = static_cast<std::size_t>(node);
    include(rest_[2 * i] + u[2 * i], rest_[2 * i + 1] + u[2 * i + 1]);
  }
  if (color_ != rheo::ColorBy::none) {
    scalars_.resize(u.size() / 2);
    find_scalars(simulation, color_, branch_, scalars_);
    for (std::size_t i = 0; i < u.size() / 2; ++i) {
      const double value = scalars_[i];
      record_[u.size() + i] = static_cast<float>(value);
      range_ = {std::min(range_[0], value), std::max(range_[1], value)};
    }
    color_values_ += static_cast<std::int64_t>(u.size() / 2);
  }
  pending_ = !kept_.has(k);
  if (!pending_) store_.append(record_);

  RecordedLoads loads{.t = simulation.time(), .tractions = simulation.active_tractions(), .held = {}};
  std::vector<int> held = simulation.held_dofs();
  if (!loads_.empty() && *loads_.back().held == held)
    loads.held = loads_.back().held;
  else
    loads.held = std::make_shared<const std::vector<int>>(std::move(held));
  loads_.push_back(std::move(loads));
}

void Recorder::end() {
  if (pending_) store_.append(record_);
  pending_ = false;
}

void Recorder::put(rheo::ByteWriter& out) {
  out.put(store_.keep());
  out.put(bounds_);
  out.put(range_);
  out.put(color_values_);
  out.put(static_cast<std::uint64_t>(loads_.size()));
  const std::vector<int>* before = nullptr;
  for (const RecordedLoads& loads : loads_) {
    out.put(loads.t);
    out.put(static_cast<std::uint64_t>(loads.tractions.size()));
    for (const auto& traction : loads.tractions) {
      out.put(static_cast<std::int64_t>(traction.index));
      out.put(traction.p);
    }
    const bool others = loads.held.get() != before;
    out.put(static_cast<std::uint64_t>(others ? 1 : 0));
    if (others) out.put_list(*loads.held);
    before = loads.held.get();
  }
  out.put_list(pending_ ? record_ : std::vector<float>());
}

void Recorder::get(rheo::ByteReader& in) {
  store_.take_up(in.get<GrowingFile::Mark>());
  bounds_ = in.get<std::array<double, 4>>();
  range_ = in.get<std::array<double, 2>>();
  color_values_ = in.get<std::int64_t>();
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    RecordedLoads loads;
    loads.t = in.get<double>();
    for (auto tractions = in.get<std::uint64_t>(); tractions > 0; --tractions) {
      const auto index = static_cast<int>(in.get<std::int64_t>());
      loads.tractions.push_back({index, in.get<rheo::Vec2>()});
    }
    if (in.get<std::uint64_t>() != 0)
      loads.held = std::make_shared<const std::vector<int>>(in.get_list<int>());
    else if (!loads_.empty())
      loads.held = loads_.back().held;
    loads_.push_back(std::move(loads));
  }
  if (const auto pending = in.get_list<float>(); !pending.empty()) {
    record_ = pending;
    pending_ = true;
  }
}

std::int64_t Recorder::nearest_kept(std::int64_t k) const {
  // A run that diverged has kept its last output, planned or not.
  const auto is_kept = [&](std::int64_t i) { return kept_.has(i) || i == count() - 1; };
  for (std::int64_t away = 0;; ++away) {  // the first output is kept
    if (is_kept(k - away)) return k - away;
    if (k + away < count() && is_kept(k + away)) return k + away;
  }
}

void Recorder::read(std::int64_t k, std::vector<double>& positions, std::vector<double>& scalar) const {
  std::vector<float> record(record_.size());
  store_.read(kept_.below(k), record);
  positions = rest_;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += static_cast<double>(record[i]);
  scalar.assign(record.begin() + static_cast<std::ptrdiff_t>(positions.size()), record.end());
}

std::optional<std::array<double, 2>> Recorder::scalar_range() const {
  if (!(range_[0] <= range_[1])) return std::nullopt;
  return range_;
}

void Recorder::include(double x, double y) {
  bounds_ = {std::min(bounds_[0], x), std::min(bounds_[1], y), std::max(bounds_[2], x),
             std::max(bounds_[3], y)};
}

bool nothing_to_colour(const rheo::PictureSettings& picture, const Recorder& recorder) {
  return picture.range_auto && recorder.scalar_range() == std::array<double, 2>{0.0, 0.0};
}

}  // namespace app
