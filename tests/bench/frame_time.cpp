// Frame by frame: a block of tissue pushed and released, physics and off-screen drawing, as a user would see
// it. How long frames take (not only in the middle), and the largest mesh that keeps up.
//
//   rheo_bench_frame_time [--seconds S] [--frames N] [--least N] [--most TRIANGLES] [--share R] [--csv FILE]
//
// Physics steps are as long as they may be, 0.9 of the stable limit unless --share says otherwise: for
// looking and feeling, not for measuring. A row has at least 100 frames (--least), however long they take: of
// fewer the 99th percentile is the worst. Frames follow each other without waiting. "Holds" a rate: 99 of 100
// frames take no longer than its period. Cores: a process each, bound to them; physics has as many threads,
// the software rasteriser too. Not here encoding, a window

#include <fmt/format.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/context.hpp"
#include "render/mesh_picture.hpp"
#include "rheo/rheo.hpp"

namespace {

struct Options {
  double seconds = 5.0;   // at most, a row
  double frames = 600.0;  // at most, a row
  double least = 100.0;   // frames, a row
  double most = 100'000;  // triangles
  double share = 0.9;     // of the stable step
  std::string csv;
};

// 0.1 m x 0.1 m, 50 mm thick: E = 20 kPa, nu = 0.4, 1000 kg/m^3, relaxing within a second; fixed at the
// bottom.
rheo::Scene tissue(int cells) {
  rheo::Scene scene;
  scene.mesh = rheo::rectangle({0.1, 0.1}, cells + 1, cells + 1, rheo::Diagonal::alternating);
  scene.mesh.thickness = 0.05;
  const double young = 20e3, poisson = 0.4, relaxation = 1.0;
  const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  const double mu = young / (2 * (1 + poisson));
  scene.material = {.lambda_ela = lambda,
                    .mu_ela = mu,
                    .lambda_vis = lambda * relaxation,
                    .mu_vis = mu * relaxation,
                    .density = 1000.0};
  scene.fixes.emplace_back().nodes = rheo::nodes_of(scene.mesh.edge_groups.at("bottom"));
  scene.time.duration = 1.0;
  return scene;
}

int cells_of(double triangles) {
  return std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / 2.0))));
}

using Clock = std::chrono::steady_clock;
double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// The block under its script: pressed on the middle of its top for the first half of every second, or, for
// haptics, held there and moved.
class Block {
 public:
  Block(int cells, double rate, int threads, double share)
      : rate_(rate), live_(make(cells, rate, threads, share)) {}

  int triangles() const { return static_cast<int>(scene().mesh.triangles.size()); }
  const rheo::Scene& scene() const { return live_.simulation().scene(); }
  const rheo::Simulation& simulation() const { return live_.simulation(); }
  double time() const { return live_.time(); }
  rheo::Vec2 traction() const { return live_.traction(tool); }
  double steps_a_tick() const {
    return static_cast<double>(simulation().counters().steps) / static_cast<double>(live_.ticks());
  }

  // Both return false after a divergence.
  bool push_and_release() {
    const double second = std::fmod(live_.time(), 1.0);
    live_.push(tool, {0.0, second < 0.5 ? -500.0 : 0.0});
    return !live_.tick();
  }
  bool hold_and_feel() {
    if (!live_.is_grabbed(tool)) live_.grab(tool);
    const double t = live_.time() + 1.0 / rate_;
    live_.drag(tool, {0.0, -0.0025 * (1.0 - std::cos(6.283185307179586 * t))});
    const bool fine = !live_.tick();
    felt_ += live_.read(tool).force.y;
    return fine;
  }
  double felt() const { return felt_; }

  static constexpr int tool = 0;

 private:
  static rheo::Live make(int cells, double rate, int threads, double share) {
    rheo::LiveSettings settings;
    settings.rate = rate;
    settings.simulation.energies = false;
    settings.simulation.threads = threads;
    settings.simulation.stable_share = share;
    rheo::Scene scene = tissue(cells);
    rheo::Handle& handle = settings.handles.emplace_back();
    handle.name = "tool";
    for (const rheo::Edge& edge : scene.mesh.edge_groups.at("top")) {
      const double x = 0.5 * (scene.mesh.points[edge[0]].x + scene.mesh.points[edge[1]].x);
      if (std::abs(x - 0.05) <= 0.0167 + 0.05 / cells) handle.edges.push_back(edge);
    }
    return {std::move(scene), settings};
  }

  double rate_;
  rheo::Live live_;
  double felt_ = 0.0;
};

// The block's picture, with all that a frame has.
class Picture {
 public:
  Picture(render::Context& context, const Block& block) : held_(block.simulation().held_dofs()) {
    const rheo::Mesh& mesh = block.scene().mesh;
    for (const rheo::Vec2& p : mesh.points) rest_.insert(rest_.end(), {p.x, p.y});
    for (const rheo::Triangle& t : mesh.triangles) triangles_.insert(triangles_.end(), t.begin(), t.end());
    for (const rheo::Edge& e : mesh.edge_groups.at("boundary"))
      boundary_.insert(boundary_.end(), e.begin(), e.end());
    for (const rheo::Edge& e : mesh.edge_groups.at("top")) {
      if (std::abs(mesh.points[e[0]].x - 0.05) < 0.0167) pushed_.push_back(e);
    }
    positions_ = rest_;
    scalar_.resize(mesh.points.size());
    arrows_.resize(pushed_.size());
    render::MeshLayout layout;
    layout.rest = rest_;
    layout.triangles = triangles_;
    layout.boundary = boundary_;
    layout.title = "Tissue";
    layout.scalar_name = "|w_lambda|";
    layout.scalar_unit = "Pa m";
    layout.range = {0.0, 60.0};
    layout.bounds = {-0.01, 0.0, 0.11, 0.105};
    layout.arrow_scale = 500.0;
    picture_ = std::make_unique<render::MeshPicture>(context, layout);
  }

  void draw(const Block& block) {
    const auto u = block.simulation().u(), w = block.simulation().w_lambda();
    for (std::size_t i = 0; i < rest_.size(); ++i) positions_[i] = rest_[i] + u[i];
    for (std::size_t i = 0; i < scalar_.size(); ++i) scalar_[i] = std::hypot(w[2 * i], w[2 * i + 1]);
    const rheo::Vec2 p = block.traction();
    for (std::size_t e = 0; e < pushed_.size(); ++e) {
      const auto i = 2 * static_cast<std::size_t>(pushed_[e][0]),
                 j = 2 * static_cast<std::size_t>(pushed_[e][1]);
      arrows_[e] = {{0.5 * (positions_[i] + positions_[j]), 0.5 * (positions_[i + 1] + positions_[j + 1])},
                    {p.x, p.y}};
    }
    const bool pushed = !(p == rheo::Vec2{});
    picture_->draw({.positions = positions_,
                    .scalar = scalar_,
                    .held = held_,
                    .arrows = std::span(arrows_).first(pushed ? arrows_.size() : 0),
                    .time = block.time()},
                   image_);
  }

 private:
  std::vector<double> rest_, positions_, scalar_;
  std::vector<int> triangles_, boundary_, held_;
  std::vector<rheo::Edge> pushed_;
  std::vector<render::TractionArrow> arrows_;
  std::unique_ptr<render::MeshPicture> picture_;
  render::Image image_;
};

struct Times {
  int triangles = 0;
  double steps = 0.0;                           // a tick
  std::vector<double> frame, physics, drawing;  // [s], sorted
  bool fine = true;

  static double at(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size() - 1)))];
  }
};

enum class What { physics_and_drawing, physics_with_force };

// `context`: null for physics alone.
Times measure(int cells, double rate, int threads, const Options& options, What what,
              render::Context* context) {
  Block block(cells, rate, threads, options.share);
  std::unique_ptr<Picture> picture;
  if (context != nullptr) {
    picture = std::make_unique<Picture>(*context, block);
    picture->draw(block);  // shaders are compiled at the first draw
  }
  const auto advance = [&] {
    return what == What::physics_and_drawing ? block.push_and_release() : block.hold_and_feel();
  };
  Times times;
  times.triangles = block.triangles();
  for (int k = 0; k < 3; ++k) times.fine = times.fine && advance();
  const Clock::time_point start = Clock::now();
  const auto most = static_cast<std::size_t>(options.frames);
  const auto least = static_cast<std::size_t>(options.least);
  while (times.frame.size() < most && (since(start) < options.seconds || times.frame.size() < least)) {
    const Clock::time_point begin = Clock::now();
    times.fine = times.fine && advance();
    const double physics = since(begin);
    if (picture) picture->draw(block);
    const double whole = since(begin);
    times.physics.push_back(physics);
    times.drawing.push_back(whole - physics);
    times.frame.push_back(whole);
  }
  times.steps = block.steps_a_tick();
  for (auto* list : {&times.frame, &times.physics, &times.drawing}) std::sort(list->begin(), list->end());
  if (!std::isfinite(block.felt())) times.fine = false;
  return times;
}

// Milliseconds with three digits.
std::string ms(double seconds) {
  return fmt::format("{:.3g}", 1e3 * seconds);
}

// The largest mesh between lowest and most whose frames hold the rate, by bisection over the cells a side.
Times largest_that_holds(double rate, int threads, Options options, What what, render::Context* context) {
  options.seconds = std::min(options.seconds, 3.0);
  options.least = 5.0;  // what holds a rate has many
  const auto holds = [&](const Times& t) { return t.fine && Times::at(t.frame, 0.99) <= 1.0 / rate; };
  // What fails is tried once more: another process may have been in the way.
  const auto try_with = [&](int cells) {
    Times times = measure(cells, rate, threads, options, what, context);
    return holds(times) ? times : measure(cells, rate, threads, options, what, context);
  };
  int low = 1, high = cells_of(options.most);
  Times best = try_with(low);
  if (!holds(best)) return {};
  while (high - low > std::max(1, low / 50)) {  // to 4 % in triangles
    const int middle = static_cast<int>(std::lround(std::sqrt(static_cast<double>(low) * high)));
    const int cells = std::clamp(middle, low + 1, high - 1);
    Times times = try_with(cells);
    if (holds(times)) {
      best = std::move(times);
      low = cells;
    } else {
      high = cells;
    }
  }
  return best;
}

// This process' part of the tables, on `cores` cores. 77: no graphics.
int run_on(int cores, const Options& options) {
  cpu_set_t allowed, mine;
  sched_getaffinity(0, sizeof allowed, &allowed);
  CPU_ZERO(&mine);
  for (int cpu = 0, left = cores; cpu < CPU_SETSIZE && left > 0; ++cpu) {
    if (!CPU_ISSET(cpu, &allowed)) continue;
    CPU_SET(cpu, &mine);
    --left;
  }
  sched_setaffinity(0, sizeof mine, &mine);
  // 0: the rasteriser draws in the calling thread.
  setenv("LP_NUM_THREADS", std::to_string(cores > 1 ? cores : 0).c_str(), 1);
  std::unique_ptr<render::Context> context;
  try {
    context = render::open_context(render::Backend::automatic, 1280, 720);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 77;
  }
  std::FILE* csv = options.csv.empty() ? nullptr : std::fopen(options.csv.c_str(), "a");
  bool fine = true;
  const auto row = [&](const char* kind, double rate, const Times& t, bool drawn) {
    if (t.frame.empty()) {
      fmt::print("| {} | {:g} Hz | {} | none | | | | | | | |\n", kind, rate, cores);
      return;
    }
    fine = fine && t.fine;
    const auto at = [&](double share) { return Times::at(t.frame, share); };
    fmt::print("| {} | {:g} Hz | {} | {} | {:.0f} | {} | {} | {} | {} | {} | {} |\n", kind, rate, cores,
               t.triangles, t.steps, ms(Times::at(t.physics, 0.5)),
               drawn ? ms(Times::at(t.drawing, 0.5)) : "", ms(at(0.5)), ms(at(0.95)), ms(at(0.99)),
               ms(at(1.0)));
    std::fflush(stdout);
    if (csv == nullptr) return;
    fmt::print(csv, "{},{:g},{},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", kind, rate, cores,
               t.triangles, t.steps, t.frame.size(), Times::at(t.physics, 0.5), Times::at(t.drawing, 0.5),
               at(0.5), at(0.95), at(0.99), at(1.0));
  };
  for (const double rate : {60.0, 90.0}) {
    for (const double triangles : {10.0, 100.0, 1e3, 1e4, 1e5}) {
      if (triangles > options.most) continue;
      row("frame", rate,
          measure(cells_of(triangles), rate, cores, options, What::physics_and_drawing, context.get()), true);
    }
  }
  for (const double rate : {60.0, 90.0}) {
    row("largest, drawn", rate,
        largest_that_holds(rate, cores, options, What::physics_and_drawing, context.get()), true);
  }
  row("largest, force read", 1000.0,
      largest_that_holds(1000.0, cores, options, What::physics_with_force, nullptr), false);
  if (csv != nullptr) std::fclose(csv);
  return fine ? 0 : 1;
}

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 == argc) {
      fmt::print(stderr, "{}: a value is needed\n", name);
      return false;
    }
    if (name == "--csv") {
      options.csv = argv[i + 1];
      continue;
    }
    double* value = name == "--seconds"  ? &options.seconds
                    : name == "--frames" ? &options.frames
                    : name == "--least"  ? &options.least
                    : name == "--most"   ? &options.most
                    : name == "--share"  ? &options.share
                                         : nullptr;
    if (value == nullptr) {
      fmt::print(stderr, "{}: unknown; --seconds, --frames, --least, --most, --share, --csv are allowed\n",
                 name);
      return false;
    }
    *value = std::strtod(argv[i + 1], nullptr);
    if (!(*value > 0.0)) {
      fmt::print(stderr, "{} {}: a number > 0 is needed\n", name, argv[i + 1]);
      return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) return 2;
  if (!options.csv.empty()) {
    std::FILE* csv = std::fopen(options.csv.c_str(), "w");
    if (csv == nullptr) {
      fmt::print(stderr, "{}: cannot be written\n", options.csv);
      return 4;
    }
    fmt::print(csv,
               "kind,rate,cores,triangles,steps,frames,physics_median,drawing_median,median,p95,p99,worst\n");
    std::fclose(csv);
  }
  fmt::print(
      "Milliseconds a frame, 1280 x 720; physics steps of at most {:g} of the stable limit; at least {:g} "
      "frames a row.\n\n"
      "| what | rate | cores | triangles | steps a tick | physics | drawing | median | 95 % | 99 % | worst "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      options.share, std::min(options.least, options.frames));
  std::fflush(stdout);
  int status = 0;
  for (const int cores : {1, 2}) {
    // A process of its own: threads and graphics start with what it may use.
    const pid_t child = fork();
    if (child == 0)
      _exit([&] {
        const int result = run_on(cores, options);
        std::fflush(stdout);
        return result;
      }());
    int state = 0;
    waitpid(child, &state, 0);
    status = std::max(status, WIFEXITED(state) ? WEXITSTATUS(state) : 1);
  }
  return status;
}
