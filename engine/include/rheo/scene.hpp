// Everything that defines a simulation, as plain data: what a scene file holds, after its names are resolved.
//
// Units    SI
// Errors   validate: Error::Kind::input; the text begins with the item's `where`
// Not here reading files (io/scene_file.hpp); nothing here knows about pictures but the settings a file may
// carry
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rheo/limits.hpp"
#include "rheo/material.hpp"
#include "rheo/material_origin.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

inline constexpr double forever = std::numeric_limits<double>::infinity();

enum class Axis { both, x, y };

// Active for from <= t < until. [s]
struct Window {
  double from = 0.0;
  double until = forever;
};

// Holds nodes where they are at window.from.
struct Fix {
  std::vector<int> nodes;
  Axis axis = Axis::both;
  Window window;
  std::string where;  // for messages: "beam.toml:23: [[fix]]"
};

enum class Profile {
  smooth,  // quintic between keys, at rest at each key (C2)
  linear,  // the velocity jumps at the keys
  hermite  // cubic with the given velocities at the keys (C1)
};

// One row of a prescribed motion: time [s], displacement [m], velocity [m/s] (hermite only).
struct MoveKey {
  double t = 0.0;
  Vec2 u;
  Vec2 v;
};

// Prescribed motion: b(t) = u(from) + key(t) - key(from), constant outside the keys.
struct Move {
  std::vector<int> nodes;
  Axis axis = Axis::both;
  Window window;
  std::vector<MoveKey> keys;  // at least one, times strictly rising
  Profile profile = Profile::smooth;
  std::string where;
};

// sum of coefficient * u(node, axis) = value, by Baumgarte's stabilisation (equation 4).
struct ConstraintTerm {
  int node = 0;
  Axis axis = Axis::x;  // x or y
  double coefficient = 0.0;
};
struct Constraint {
  std::vector<ConstraintTerm> terms;
  double value = 0.0;
  std::string where;
};

struct TractionKey {
  double t = 0.0;
  Vec2 p;  // [Pa]
};

// A pressure of fixed direction over the reference length of edges: h l P / 2 to each of an edge's nodes.
struct Traction {
  std::vector<Edge> edges;
  std::vector<TractionKey>
      keys;  // one: constant; more: linear between, constant outside; times strictly rising
  Window window;
  std::string where;
};

// Mean displacement and total force (reaction + traction) of a group of nodes.
struct Probe {
  std::string name;
  std::vector<int> nodes;
  std::vector<Edge> edges;  // where the group was given as edges; else empty
  std::string where;
};

enum class IntegratorKind {
  rk4,
  euler,
  exponential,
  implicit,
  automatic  // rk4; with an accuracy the one that is forecast to reach it in the least time
};
enum class ConstraintMethod {
  automatic,  // eliminate what can be, Baumgarte for the general ones
  baumgarte   // equation (4) for all of them
};

struct TimeSettings {
  double duration = 0.0;     // [s], > 0, finite
  double frame_rate = 60.0;  // outputs per second
  IntegratorKind integrator = IntegratorKind::automatic;
  double step = 0.0;         // upper bound [s]; 0: a quarter of the stable limit; exponential, implicit: none
  double refinement = 1.0;   // >= 1: so many times the steps that `step` gives, each stretch rounded up
  double tolerance = 1e-10;  // exponential: relative error of a run
  double accuracy = 0.0;     // error at the outputs for which step or tolerance is chosen (accuracy.hpp);
                             // 0: not asked for
  double baumgarte = 20.0;   // omega [1/s]; 0: no stabilisation, constraints hold to the rounding of A^T v
  ConstraintMethod constraints = ConstraintMethod::automatic;
  double most_outputs = max_outputs;  // that duration and frame_rate may give
  std::string where;                  // for messages about the step: "beam.toml:31: [time]"
};

enum class ColorBy { w_lambda, w_mu, w, speed, none };

struct PictureSettings {
  ColorBy color = ColorBy::w_lambda;
  int branch = 0;  // of w: 0: all but the elastic part; 1, 2, ...: one Maxwell branch alone
  bool range_auto = true;
  std::array<double, 2> range{0.0, 1.0};  // where not automatic
  std::array<int, 2> size{1280, 720};     // pixels
  int every = 1;                          // outputs from one frame to the next; the last output has one too
  double arrow_scale = 0.0;               // traction of the longest arrow [Pa]; 0: the run's largest
  std::optional<std::array<double, 4>>
      bounds;                 // x0, y0, x1, y1 that pictures show [m]; none: the whole motion
  std::vector<double> sheet;  // times of the sheet's shapes, strictly rising [s], at most most_sheet_times;
                              // empty: as suits the run
  std::vector<std::string> captions;  // of these shapes, each may be empty; as many as times, or none
};

// A further material in the mesh. All materials of a scene have the same kind of mass.
struct Region {
  std::string name;
  Material material;
  MaterialOrigin origin;
  std::string where;  // for messages
};

// One of several bodies: separate pieces of the scene's mesh, its nodes and triangles in a row.
struct BodyPart {
  std::string name;
  std::int32_t first_node = 0, node_count = 0;
  std::int32_t first_triangle = 0, triangle_count = 0;
};

struct Scene {
  std::string title;
  Mesh mesh;  // prepared; of all bodies
  Material material;
  MaterialOrigin origin;                         // of the material, for reports
  std::string material_name;                     // for reports; empty: it has none
  std::vector<Region> regions;                   // materials 1, 2, ... beside `material`, which is 0
  std::vector<std::int32_t> region_of_triangle;  // which of them each triangle is of; empty: all 0
  std::vector<BodyPart> bodies;                  // empty: one body
  Vec2 body_acceleration;                        // [m/s^2]
  std::vector<Fix> fixes;
  std::vector<Move> moves;
  std::vector<Constraint> constraints;
  std::vector<Traction> tractions;
  std::vector<Probe> probes;
  TimeSettings time;
  PictureSettings picture;
  std::vector<std::string>
      notes;  // remarks of the reader for the user ("12 clockwise triangles turned round")
  std::vector<std::string> files;  // that the scene file names and the reader opened, each once
};

// Material 0, 1, ... of a scene.
inline const Material& material_of(const Scene& scene, std::size_t number) {
  return number == 0 ? scene.material : scene.regions[number - 1].material;
}
// Of the material with the most.
std::size_t most_branches(const Scene& scene);

// Limits against slips of the pen that would fill a disk or never end.
inline constexpr double max_steps = 1e12;                        // duration / step
inline constexpr std::array<int, 2> min_picture_size{240, 160};  // below it texts do not fit; width, height
inline constexpr int max_picture_side = 16384;                   // what OpenGL draws
inline constexpr std::size_t most_sheet_times = 64;
inline constexpr int most_every = 1'000'000'000;  // outputs from one frame to the next
// Of frame buffers with 4 samples and depth, and of two pictures on their way to a file.
inline constexpr double bytes_a_pixel = 48.0;

inline constexpr double finest_tolerance = 1e-13;  // below it rounding rules
inline constexpr double coarsest_tolerance = 0.1;

// The implicit integrator keeps the factors of its latest step sizes: as many as the budget holds, within
// these.
inline constexpr int fewest_factors = 2;
inline constexpr int most_factors = 6;
inline constexpr double factors_budget = 512e6;  // bytes
inline constexpr double finest_accuracy = 1e-13;
inline constexpr double coarsest_accuracy = 0.1;

// The settings alone, for values that come from elsewhere than a scene file (a command line, a panel).
void validate(const TimeSettings& time);
void validate(const PictureSettings& picture);

// Checks values and node numbers; what depends on the active constraints is checked by Simulation's
// constructor.
void validate(const Scene& scene);

}  // namespace rheo
