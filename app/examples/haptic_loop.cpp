// A haptic loop: at a fixed rate (1 kHz by default) a finger holds the top of a block of tissue and moves it,
// and the force that it feels is read. Prints how late the loop woke up and how long its ticks took.
//
//   haptic_loop [--rate HZ] [--triangles N] [--seconds S] [--threads N]
//
// Not here a device: the finger's place is a formula, the force is only looked at

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include "rheo/error.hpp"
#include "rheo/rheo.hpp"

namespace {

struct Options {
  double rate = 1000.0;    // ticks a second
  double triangles = 400;  // about
  double seconds = 2.0;
  double threads = 1.0;
};

// nullopt: said why on standard error.
std::optional<Options> read_options(int argc, char** argv) {
  Options options;
  struct Named {
    std::string_view name;
    double* value;
    double low, high;
  };
  const Named known[] = {{"--rate", &options.rate, 1.0, 1e5},
                         {"--triangles", &options.triangles, 2.0, 1e6},
                         {"--seconds", &options.seconds, 1e-3, 3600.0},
                         {"--threads", &options.threads, 1.0, 64.0}};
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    const auto* option =
        std::find_if(std::begin(known), std::end(known), [&](const Named& n) { return n.name == name; });
    if (option == std::end(known)) {
      std::fprintf(stderr, "%s: unknown; --rate, --triangles, --seconds, --threads are allowed\n", argv[i]);
      return std::nullopt;
    }
    const std::string_view text = i + 1 < argc ? argv[i + 1] : "";
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *option->value);
    if (error != std::errc{} || end != text.data() + text.size() ||
        !(*option->value >= option->low && *option->value <= option->high)) {
      std::fprintf(stderr, "%s %.*s: a number from %g to %g is needed\n", argv[i],
                   static_cast<int>(text.size()), text.data(), option->low, option->high);
      return std::nullopt;
    }
  }
  return options;
}

// 0.1 m x 0.1 m, 50 mm thick: E = 20 kPa, nu = 0.4, relaxing within a second; fixed at the bottom.
rheo::Scene tissue(double triangles) {
  const int cells = std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / 2.0))));
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

void print_percentiles(const char* name, std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1e6 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  std::printf("%-12s median %8.1f  95%% %8.1f  99%% %8.1f  worst %8.1f microseconds\n", name, at(0.5),
              at(0.95), at(0.99), at(1.0));
}

// Counts in bins that double.
void print_histogram(const std::vector<double>& seconds) {
  constexpr int bins = 14;  // 1 microsecond to 8 ms and beyond
  int counts[bins] = {};
  for (const double s : seconds)
    ++counts[std::clamp(static_cast<int>(std::ceil(std::log2(std::max(1e6 * s, 1e-9)))), 0, bins - 1)];
  for (int k = 0; k < bins; ++k) {
    if (counts[k] == 0) continue;
    const double share = counts[k] / static_cast<double>(seconds.size());
    if (k + 1 < bins) {
      std::printf("  <= %5d microseconds %7d  ", 1 << k, counts[k]);
    } else {
      std::printf("   > %5d microseconds %7d  ", 1 << (bins - 2), counts[k]);
    }
    for (int bar = 0; bar < std::lround(40 * share); ++bar) std::putchar('#');
    std::putchar('\n');
  }
}

int run(const Options& options) {
  rheo::LiveSettings settings;
  settings.rate = options.rate;
  settings.simulation.energies = false;  // nobody looks
  settings.simulation.threads = static_cast<int>(options.threads);
  settings.simulation.stable_share = 0.9;
  rheo::Scene scene = tissue(options.triangles);
  constexpr int finger = 0;
  settings.handles.emplace_back().name = "finger";
  for (const int node : rheo::nodes_of(scene.mesh.edge_groups.at("top"))) {
    if (std::abs(scene.mesh.points[node].x - 0.05) <= 0.0151) settings.handles[finger].nodes.push_back(node);
  }
  if (settings.handles[finger].nodes.empty())
    settings.handles[finger].nodes = rheo::nodes_of(scene.mesh.edge_groups.at("top"));
  rheo::Live live(std::move(scene), settings);

  const auto ticks = static_cast<std::size_t>(std::max(1.0, std::round(options.seconds * options.rate)));
  std::vector<double> lateness(ticks), took(ticks);
  double strongest = 0.0;
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin, Clock::time_point end) {
    return std::chrono::duration<double>(end - begin).count();
  };

  live.grab(finger);
  const Clock::time_point start = Clock::now();
  for (std::size_t k = 0; k < ticks; ++k) {
    const Clock::time_point due =
        start + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(k) / options.rate));
    std::this_thread::sleep_until(due);
    const Clock::time_point woken = Clock::now();
    // Where the finger is to be: 5 mm down and up again, once a second.
    const double t = live.time() + 1.0 / options.rate;
    live.drag(finger, {0.0, -0.0025 * (1.0 - std::cos(2.0 * std::numbers::pi * t))});
    if (const auto diverged = live.tick()) {
      std::fprintf(stderr, "diverged at %g s: the largest stable step is %g s\n", diverged->t,
                   diverged->stable_step);
      return 3;
    }
    strongest = std::max(strongest, std::abs(live.read(finger).force.y));
    took[k] = since(woken, Clock::now());
    lateness[k] = since(due, woken);
  }

  const rheo::Simulation& simulation = live.simulation();
  std::printf("%d triangles, %g Hz, %lld steps a tick, %d threads; strongest force %.3f N\n",
              static_cast<int>(simulation.scene().mesh.triangles.size()), options.rate,
              static_cast<long long>(simulation.counters().steps / static_cast<std::int64_t>(ticks)),
              simulation.threads(), strongest);
  print_percentiles("tick", took);
  print_percentiles("woken late", lateness);
  print_histogram(lateness);
  const auto missed =
      std::count_if(took.begin(), took.end(), [&](double s) { return s > 1.0 / options.rate; });
  std::printf("%zu ticks, %lld longer than their time\n", ticks, static_cast<long long>(missed));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = read_options(argc, argv);
  if (!options) return 2;
  try {
    return run(*options);
  } catch (const rheo::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
