#include "linearity_watch.hpp"

#include <fmt/format.h>

#include <numbers>

#include "rheo/deformation.hpp"

namespace app {
namespace {

std::string place(const rheo::Mesh& mesh, int triangle) {
  rheo::Vec2 middle;
  for (const int node : mesh.triangles[static_cast<std::size_t>(triangle)]) {
    middle.x += mesh.points[static_cast<std::size_t>(node)].x / 3.0;
    middle.y += mesh.points[static_cast<std::size_t>(node)].y / 3.0;
  }
  return fmt::format("triangle {} (at rest around x = {:.4g} m, y = {:.4g} m)", triangle, middle.x, middle.y);
}

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

}  // namespace

void LinearityWatch::record(rheo::Simulation& simulation, std::int64_t) {
  if (inverted_ && strained_ && rotated_) return;
  const rheo::Mesh& mesh = simulation.scene().mesh;
  const rheo::LinearityReport report = rheo::check_linearity(mesh, simulation.u());
  const double t = simulation.time();
  if (!inverted_ && report.inverted > 0) {
    inverted_ = true;
    warn(fmt::format("t = {:.4g} s: {} turned inside out ({} of {} triangles by now)", t,
                     place(mesh, report.first_inverted), report.inverted, mesh.triangle_count()));
  }
  if (!strained_ && report.strain > rheo::strain_limit) {
    strained_ = true;
    warn(fmt::format("t = {:.4g} s: strain {:.3g} in {}: beyond {:.2g} linear strain loses its meaning", t,
                     report.strain, place(mesh, report.most_strained), rheo::strain_limit));
  }
  if (!rotated_ && report.rotation > rheo::rotation_limit) {
    rotated_ = true;
    warn(fmt::format("t = {:.4g} s: rotation of {:.3g} degrees in {}: beyond {:.2g} a linear model swells", t,
                     degrees(report.rotation), place(mesh, report.most_rotated),
                     degrees(rheo::rotation_limit)));
  }
}

void LinearityWatch::put(rheo::ByteWriter& out) const {
  for (const bool said : {inverted_, strained_, rotated_}) out.put(static_cast<std::uint64_t>(said ? 1 : 0));
  out.put(static_cast<std::uint64_t>(warnings_.size()));
  for (const std::string& warning : warnings_) out.put_text(warning);
}

void LinearityWatch::get(rheo::ByteReader& in) {
  for (bool* said : {&inverted_, &strained_, &rotated_}) *said = in.get<std::uint64_t>() != 0;
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) warnings_.push_back(in.get_text());
}

void LinearityWatch::warn(const std::string& text) {
  warnings_.push_back(text);
  progress_.line("warning: " + text);
}

}  // namespace app
