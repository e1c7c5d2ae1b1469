#include "kills.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "rheo/error.hpp"
#include "rheo/io/checkpoint.hpp"

namespace fault_tests {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::exists(folder)) return names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  std::ranges::sort(names);
  return names;
}

bool is_part(const std::string& name) {
  return name.ends_with(".part");
}

std::string scene_text(int columns, int rows, const std::string& mass, const std::string& more,
                       double duration, double frame_rate, const std::string& integrator) {
  return fmt::format(R"(title = "A beam to be killed"
[mesh]
shape = "rectangle"
size = [1.0, 0.25]
nodes = [{}, {}]
diagonal = "alternating"
[material]
lambda_ela = 7.0
mu_ela = 5.0
lambda_vis = 4.0
mu_vis = 2.0
density = 0.2
mass = "{}"
[[fix]]
edges = "left"
[[traction]]
edges = "right"
keys = [[0.0, 0.0, 0.0], [0.3, 2.0, 0.5], [0.77, 0.0, 0.0]]
[[probe]]
name = "grip"
edges = "right"
{}
[time]
duration = {}
frame_rate = {}
integrator = "{}"
[render]
size = [320, 180]
)",
                     columns, rows, mass, more, duration, frame_rate, integrator);
}

}  // namespace

std::vector<RunCase> run_cases(double length, bool pictures) {
  const std::string grab =
      "[[move]]\nedges = \"right\"\nkeys = [[0.9, 0.0, 0.0], [1.2, 0.1, 0.02]]\nfrom = 0.9\nuntil = 1.5\n";
  const std::string tie = "[[constraint]]\nterms = [[5, \"x\", 1.0], [7, \"x\", -1.0]]\nvalue = 0.0\n";
  const std::string region =
      "[[region]]\nname = \"core\"\ndisk = [0.5, 0.125, 0.1]\n[region.material]\nlambda_ela = 20.0\nmu_ela = "
      "9.0\nlambda_vis = 9.0\nmu_vis = 5.0\ndensity = 0.2\n";
  const std::vector<std::string> always{"--checkpoint", often, "-o", "r"};
  const auto with = [&](std::vector<std::string> first, std::vector<std::string> more = {}) {
    first.push_back("scene.toml");
    first.insert(first.end(), always.begin(), always.end());
    first.insert(first.end(), more.begin(), more.end());
    return first;
  };
  std::vector<RunCase> cases{
      {"rk4, edge", scene_text(41, 11, "lumped", grab, 2.0 * length, 200, "rk4"), with({"run"})},
      {"rk4, several materials, vtu", scene_text(49, 13, "lumped", grab + region, 2.0 * length, 60, "rk4"),
       with({"run"}, {"--vtu"})},
      {"rk4, edge, 3,200 triangles", scene_text(81, 21, "lumped", grab, 2.0 * length, 60, "rk4"),
       with({"run"})},
      {"euler, csr", scene_text(9, 3, "consistent", tie, 0.4 * length, 500, "euler"), with({"run"})},
      {"exponential", scene_text(41, 11, "lumped", grab, 3.0 * length, 300, "exponential"), with({"run"})},
      {"implicit, constraint", scene_text(25, 7, "consistent", grab + tie, 2.0 * length, 100, "implicit"),
       with({"run"})}};
  if (!pictures) return cases;
  cases.push_back({"render, rk4, every 7th output", scene_text(9, 3, "lumped", grab, 2.0 * length, 60, "rk4"),
                   with({"render"}, {"--every", "7"})});
  cases.push_back({"render, exponential", scene_text(33, 9, "lumped", grab, 2.0 * length, 60, "exponential"),
                   with({"render"}, {"--color", "speed"})});
  return cases;
}

std::vector<std::string> faults_in(const fs::path& folder, const fs::path& whole) {
  std::vector<std::string> faults;
  for (const std::string& name : files_in(folder)) {
    if (is_part(name)) continue;
    const std::string text = read_text(folder / name);
    if (name == "run.json") {
      if (!nlohmann::json::accept(text)) faults.push_back("run.json is no JSON");
    } else if (name == "checkpoint.rheo") {
      try {
        rheo::read_checkpoint(folder / name);
      } catch (const rheo::Error& error) {
        faults.push_back(error.what());
      }
    } else if (text != read_text(whole / name)) {
      faults.push_back(fmt::format("{} is not the undisturbed run's ({} bytes, {} there)", name, text.size(),
                                   read_text(whole / name).size()));
    }
  }
  return faults;
}

std::vector<std::string> differences(const fs::path& folder, const fs::path& whole) {
  std::vector<std::string> faults = faults_in(folder, whole);
  const std::vector<std::string> names = files_in(folder), names_there = files_in(whole);
  if (names != names_there)
    faults.push_back(fmt::format("has {} files, {} are the undisturbed run's: {}", names.size(),
                                 names_there.size(), fmt::join(names, " ")));
  return faults;
}

KillReport kill_and_resume(const RunCase& run_case, int kills, std::mt19937_64& random,
                           const fs::path& folder) {
  KillReport report;
  report.name = run_case.name;
  const fs::path place = folder / "whole", cut_place = folder / "cut";
  for (const fs::path& each : {place, cut_place}) {
    fs::create_directories(each);
    std::ofstream(each / "scene.toml", std::ios::binary) << run_case.scene;
  }
  const Clock::time_point start = Clock::now();
  const Ended undisturbed = run(place, run_case.arguments);
  report.seconds = seconds_since(start);
  if (undisturbed.exit_code != 0) {
    report.faults.push_back("the undisturbed run failed: " + undisturbed.err);
    return report;
  }
  const auto note = [&](const std::string& when, const std::vector<std::string>& faults) {
    for (const std::string& fault : faults)
      report.faults.push_back(fmt::format("{}, kill {}: {}", when, report.kills, fault));
  };

  // The whole run and a little more: some are killed at their very end.
  std::uniform_real_distribution<double> moment(0.0, 1.05 * report.seconds);
  bool goes_on = false;
  for (int starts = 0; report.kills < kills && starts < 20 * kills + 100; ++starts) {
    std::vector<std::string> arguments = run_case.arguments;
    if (goes_on) arguments.push_back("--resume");
    Child child(cut_place, arguments);
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
    if (!child.has_ended()) child.send(SIGKILL);
    const Ended ended = child.wait();
    if (ended.out.find("note: goes on after") != std::string::npos) ++report.resumed;
    if (ended.signal == SIGKILL) {
      ++report.kills;
      const std::vector<std::string> names = files_in(cut_place / "r");
      const auto is_there = [&](const char* name) { return std::ranges::binary_search(names, name); };
      const bool draws = run_case.arguments.front() == "render" && is_there("state.csv");
      (draws ? report.drawing : is_there("checkpoint.rheo") ? report.simulating : report.beginning) += 1;
      note("after it", faults_in(cut_place / "r", place / "r"));
      goes_on = true;
      continue;
    }
    if (ended.exit_code != 0)
      note("resumed", {fmt::format("exit code {}, signal {}: {}", ended.exit_code, ended.signal, ended.err)});
    if (goes_on) ++report.ends;
    note("at the end", differences(cut_place / "r", place / "r"));
    fs::remove_all(cut_place / "r");
    goes_on = false;
  }
  if (!goes_on) return report;
  std::vector<std::string> arguments = run_case.arguments;
  arguments.push_back("--resume");
  const Ended ended = run(cut_place, arguments);
  if (ended.exit_code != 0) note("resumed", {fmt::format("exit code {}: {}", ended.exit_code, ended.err)});
  ++report.ends;
  note("at the end", differences(cut_place / "r", place / "r"));
  return report;
}

}  // namespace fault_tests
