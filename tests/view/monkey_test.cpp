// A monkey at the window: random cursor, buttons, keys, sizes and files, from a seed. RHEO_MONKEY_SECONDS and
// RHEO_MONKEY_SEED make it longer and another one; ctest lets it play for twenty seconds.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "ui_driver.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

double number_from(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atof(text) : otherwise;
}

// Resident memory. [MB]
double memory() {
  std::ifstream in("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  in >> all >> resident;
  return resident * 4096.0 / 1e6;
}

TEST(ViewMonkey, BreaksNothing) {
  const auto context = open_or_null();
  if (!context) GTEST_SKIP() << "this machine has no way to draw (libosmesa6)";
  const fs::path folder = output_folder();
  std::ofstream(folder / "broken.toml") << "[mesh]\nshape = 7\n";
  Driver user(*context, block(), folder);
  const double seconds = number_from("RHEO_MONKEY_SECONDS", 20.0);
  std::mt19937 random(static_cast<unsigned>(number_from("RHEO_MONKEY_SEED", 1.0)));
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  using app::view::Key;
  static constexpr int keys[]{32,
                              46,
                              'R',
                              'F',
                              'G',
                              'W',
                              'B',
                              'N',
                              'D',
                              'C',
                              'P',
                              258,
                              'H',
                              61,
                              45,
                              '1',
                              91,
                              93,
                              static_cast<int>(Key::home),
                              static_cast<int>(Key::escape),
                              static_cast<int>(Key::enter),
                              static_cast<int>(Key::del),
                              static_cast<int>(Key::backspace),
                              static_cast<int>(Key::left),
                              static_cast<int>(Key::right),
                              static_cast<int>(Key::f1)};
  static constexpr int writing[]{static_cast<int>(Key::f9), static_cast<int>(Key::f12), 'S'};  // files
  const fs::path scenes = fs::path(RHEO_SOURCE_DIR) / "app" / "scenes";

  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double memory_early = 0.0;
  int frames = 0;
  for (; passed() < seconds; ++frames) {
    const int what = below(100);
    if (what < 45) {
      user.input.cursor[0] += static_cast<float>(below(161) - 80);
      user.input.cursor[1] += static_cast<float>(below(121) - 60);
    } else if (what < 55) {
      user.input.cursor = {static_cast<float>(below(user.input.width)),
                           static_cast<float>(below(user.input.height))};
    } else if (what < 78) {
      const auto button = static_cast<std::size_t>(below(8) == 0 ? 1 + below(2) : 0);
      user.input.buttons[button] = !user.input.buttons[button];
    } else if (what < 84) {
      user.input.wheel = static_cast<float>(below(7) - 3);
    } else if (what < 94) {
      user.input.down.clear();
      user.input.control = user.input.shift = false;
      if (below(2) == 0) user.input.down.push_back(static_cast<Key>(keys[below(std::size(keys))]));
      user.input.shift = below(10) == 0;
      if (below(60) == 0) {
        user.input.down = {static_cast<Key>(writing[below(std::size(writing))])};
        user.input.control = user.input.down[0] == static_cast<Key>('S');
      }
    } else if (what < 96) {
      user.input.text = {static_cast<unsigned>("0123456789e.-"[below(13)])};
    } else if (what == 96) {
      user.input.width = 300 + below(1000);
      user.input.height = 200 + below(700);
    } else if (what == 97 && below(6) == 0) {
      user.input.dropped = {below(3) == 0 ? folder / "broken.toml"
                                          : scenes / (below(2) == 0 ? "beam.toml" : "liver.toml")};
    } else if (what == 98) {
      user.physics.run();
    }
    user.frame();
    if (frames == 500 || (memory_early == 0.0 && passed() > 0.3 * seconds)) memory_early = memory();
    // A body thrown out of all bounds says so and keeps its last state; NaN is never shown.
    const app::view::Display& shown = user.ui.shown();
    for (const auto* numbers :
         {&shown.positions, &shown.velocities, &shown.w_lambda, &shown.w_mu, &shown.speed}) {
      for (const double x : *numbers) ASSERT_TRUE(std::isfinite(x)) << "frame " << frames;
    }
    ASSERT_TRUE(std::isfinite(shown.energies.kinetic) && std::isfinite(shown.energies.stored));
  }
  std::printf("%d frames in %.0f s; memory %.1f MB at first, %.1f MB at the end\n", frames, passed(),
              memory_early, memory());
  EXPECT_GT(frames, 10);
  // Pictures of other sizes, scenes and a session's keys come and go.
  EXPECT_LT(memory(), memory_early + 150.0);
}

}  // namespace
}  // namespace view_tests
