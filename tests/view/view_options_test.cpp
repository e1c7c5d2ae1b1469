// Every option that `rheo view --help` lists is honoured by the window.
#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>

#include "draw_or_skip.hpp"
#include "failure.hpp"
#include "rheo/error.hpp"
#include "view/view_setup.hpp"

namespace view_tests {
namespace {

using app::ViewSetup;

const std::string beam = std::string(RHEO_SOURCE_DIR) + "/app/scenes/beam.toml";

std::optional<app::Options> read(std::vector<std::string> words) {
  words.insert(words.begin(), {"rheo", "view"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  return app::read_command_line(static_cast<int>(arguments.size()), arguments.data());
}

ViewSetup with(const std::string& option, const std::vector<std::string>& values = {},
               const std::string& scene = beam) {
  std::vector<std::string> words{scene, option};
  words.insert(words.end(), values.begin(), values.end());
  return app::view_setup(*read(words));
}

// The body under the hand as the window would have it.
app::view::Display body_of(const ViewSetup& setup) {
  app::view::Core core(setup.scene, setup.core);
  app::view::Display display;
  core.show(display);
  return display;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::set<std::string> offered() {
  testing::internal::CaptureStdout();
  read({"--help"});
  std::fflush(stdout);
  const std::string help = testing::internal::GetCapturedStdout();
  std::set<std::string> options;
  const std::regex option("(?:^|\n) +(?:-[a-z],)?(--[a-z-]+)");
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it)
    options.insert((*it)[1]);
  return options;
}

const std::map<std::string, std::function<void()>>& checks() {
  static const std::map<std::string, std::function<void()>> all{
      {"--integrator",
       [] {
         const auto display = body_of(with("--integrator", {"exponential"}));
         EXPECT_EQ(display.scene->time.integrator, rheo::IntegratorKind::exponential);
       }},
      {"--step", [] { EXPECT_EQ(body_of(with("--step", {"2e-4"})).step_bound, 2e-4); }},
      {"--tolerance",
       [] {
         const auto setup = with("--integrator", {"exponential", "--tolerance", "1e-7"});
         EXPECT_EQ(body_of(setup).scene->time.tolerance, 1e-7);
       }},
      {"--allow-unstable",
       [] {
         EXPECT_THAT(refusal([] { body_of(with("--step", {"0.5"})); }), testing::HasSubstr("stable"));
         EXPECT_EQ(body_of(with("--step", {"0.5", "--allow-unstable"})).step_bound, 0.5);
       }},
      {"--kernel", [] { EXPECT_EQ(body_of(with("--kernel", {"csr"})).kernel, "csr"); }},
      {"--threads",
       [] {
         EXPECT_EQ(with("--threads", {"2"}).core.simulation.threads, 2);
         EXPECT_EQ(body_of(with("--threads", {"1"})).threads, 1);
       }},
      {"--memory-limit",
       [] { EXPECT_THAT(refusal([] { with("--memory-limit", {"1e-6"}); }), testing::HasSubstr("memory")); }},
      {"--output-limit",
       [] { EXPECT_THAT(refusal([] { with("--output-limit", {"3"}); }), testing::HasSubstr("output")); }},
      {"--allow-outside",
       [] {
         const fs::path folder = output_folder();
         fs::create_directories(folder / "inner");
         std::ofstream(folder / "keys.csv") << "0,0,0\n1,5,0\n";
         std::ofstream(folder / "inner/scene.toml") << R"([mesh]
shape = "rectangle"
size = [1.0, 0.25]
nodes = [5, 2]
[material]
lambda_ela = 7
mu_ela = 5
lambda_vis = 4
mu_vis = 2
density = 0.2
[[traction]]
edges = "right"
keys = "../keys.csv"
[time]
duration = 1
)";
         const std::string scene = (folder / "inner/scene.toml").string();
         EXPECT_THAT(refusal([&] { with("--quiet", {}, scene); }), testing::HasSubstr("--allow-outside"));
         const ViewSetup setup = with("--allow-outside", {}, scene);
         EXPECT_EQ(setup.scene.tractions.at(0).keys.size(), 2u);
         // And for what is dropped on the window later.
         EXPECT_EQ(setup.ui.read(scene).tractions.size(), 1u);
         EXPECT_NE(refusal([&] { with("--quiet").ui.read(scene); }), "");
       }},
      {"--size",
       [] {
         EXPECT_EQ(with("--size", {"640x480"}).size, (std::array<int, 2>{640, 480}));
       }},
      {"--color", [] { EXPECT_EQ(with("--color", {"speed"}).ui.style.color, rheo::ColorBy::speed); }},
      {"--range",
       [] {
         const auto style = with("--range", {"0.5,2.5"}).ui.style;
         EXPECT_EQ(style.range_mode, app::view::RangeMode::typed);
         EXPECT_EQ(style.typed, (std::array<double, 2>{0.5, 2.5}));
         EXPECT_EQ(with("--range", {"auto"}).ui.style.range_mode, app::view::RangeMode::automatic);
       }},
      {"--output",
       [] {
         EXPECT_EQ(with("--output", {"somewhere"}).ui.folder, "somewhere");
         EXPECT_EQ(with("--quiet").ui.folder, fs::path("out/beam_view"));
       }},
      // These two are of the loop around all that: window.sh looks at what they do.
      {"--close-after",
       [] {
         EXPECT_EQ(read({beam, "--close-after", "2.5"})->close_after, 2.5);
       }},
      {"--quiet",
       [] {
         EXPECT_TRUE(read({beam, "--quiet"})->quiet);
       }},
      {"--help", [] { EXPECT_FALSE(offered().empty()); }},
  };
  return all;
}

TEST(ViewOptions, EachIsHonoured) {
  std::set<std::string> checked;
  for (const auto& [option, check] : checks()) {
    SCOPED_TRACE(option);
    checked.insert(option);
    check();
  }
  EXPECT_EQ(offered(), checked);
}

TEST(ViewOptions, WhatOnlyARunHasIsRefusedByName) {
  for (const char* option : {"--accuracy", "--duration", "--frame-rate", "--no-energies", "--vtu"})
    EXPECT_THAT(refusal([&] {
                  read({beam, option, "1"});
                }),
                testing::AllOf(testing::HasSubstr(option), testing::HasSubstr("rheo view --help")));
}

TEST(ViewOptions, TheStyleActsOnThePicture) {
  RHEO_DRAW_OR_SKIP(context);
  ViewSetup setup = with("--color", {"speed", "--range", "0.25,0.75"});
  setup.ui.folder = output_folder();
  Driver user(*context, setup.scene, setup.ui);
  EXPECT_EQ(user.ui.picture().range(), (std::array<double, 2>{0.25, 0.75}));
  EXPECT_EQ(user.ui.style().color, rheo::ColorBy::speed);
}

}  // namespace
}  // namespace view_tests
