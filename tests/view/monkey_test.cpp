// A monkey at the window: random cursor, buttons, keys, sizes and files, from a seed. RHEO_MONKEY_SECONDS and
// RHEO_MONKEY_SEED make it longer and another one; ctest lets it play for twenty seconds.
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "rheo/io/scene_text.hpp"
#include "ui_driver.hpp"
#include "view_scene.hpp"

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
// Of the sanitizers' runtimes; GCC 12 has no header for it.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace view_tests {
namespace {

double number_from(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atof(text) : otherwise;
}

// What the program has taken from the heap and not given back. [MB] Resident memory would not do: an
// allocator keeps what is freed.
double heap_in_use() {
#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
  return static_cast<double>(__sanitizer_get_current_allocated_bytes()) / 1e6;
#else
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
#endif
}

// The same with the window as it was at first: nothing pressed, its first size and body, paused, and so many
// frames that all that is kept of the last ones is full.
double heap_at_home(Driver& user, const fs::path& home) {
  user.input = {};
  user.frames(2);
  user.key(app::view::Key::escape);
  user.frame();
  if (user.says("recording, frame")) user.key(app::view::Key::f9);
  const std::int64_t body = user.ui.shown().body;
  user.input.dropped = {home};
  user.frame();
  EXPECT_TRUE(user.until([&](const app::view::Display& d) { return d.body != body; }));
  user.physics.pause();
  user.physics.set_speed(1.0);
  user.frames(260);
  return heap_in_use();
}

TEST(ViewMonkey, BreaksNothing) {
  const auto context = open_or_null();
  if (!context) GTEST_SKIP() << "this machine has no way to draw (libosmesa6)";
  const fs::path folder = output_folder();
  std::ofstream(folder / "broken.toml") << "[mesh]\nshape = 7\n";
  std::ofstream(folder / "home.toml") << rheo::scene_text(block());
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
  double heap_early = 0.0;
  int frames = 0, frames_early = 0;
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
    if (heap_early == 0.0 && passed() > 0.1 * seconds) {
      heap_early = heap_at_home(user, folder / "home.toml");
      frames_early = frames;
    }
    // A body thrown out of all bounds says so and keeps its last state; NaN is never shown.
    const app::view::Display& shown = user.ui.shown();
    for (const auto* numbers :
         {&shown.positions, &shown.velocities, &shown.w_lambda, &shown.w_mu, &shown.speed}) {
      for (const double x : *numbers) ASSERT_TRUE(std::isfinite(x)) << "frame " << frames;
    }
    ASSERT_TRUE(std::isfinite(shown.energies.kinetic) && std::isfinite(shown.energies.stored));
  }
  const double heap_late = heap_at_home(user, folder / "home.toml");
  std::printf("%d frames in %.0f s; heap in use %.2f MB after %d frames, %.2f MB at the end\n", frames,
              passed(), heap_early, frames_early, heap_late);
  EXPECT_GT(frames, 10);
  // Room that the largest body seen has left behind, shaders, frame times. In ten minutes, some 20,000
  // frames, a leak of 1 kB a frame is more than this.
  EXPECT_LT(heap_late, heap_early + 6.0);
}

}  // namespace
}  // namespace view_tests
