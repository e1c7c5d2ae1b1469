#include "run_identity.hpp"

#include <fmt/format.h>

#include <iterator>
#include <sstream>

#include "option_values.hpp"
#include "rheo/fingerprint.hpp"

namespace app {

std::string run_identity(const Options& options, const rheo::Scene& scene, const std::string& scene_text,
                         const std::vector<Fingerprint>& read_files) {
  std::string text;
  const auto add = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{}: {}\n", name, value);
  };
  const auto number = [](double value) { return fmt::format("{:.17g}", value); };
  const auto flag = [](bool value) { return std::string(value ? "yes" : "no"); };

  add("the command", options.command == Command::render ? "render" : "run");
  add("rheo", RHEO_VERSION);
  add("the scene file's content", fmt::format("{:016x}", rheo::checksum(scene_text)));
  rheo::Fingerprint files;
  for (const Fingerprint& file : read_files) {
    files.add(file.bytes.value_or(0));
    files.add(file.fnv1a.value_or(0));
  }
  add("the content of the files that the scene names", fmt::format("{:016x}", files.value()));
  std::string start = "none";
  if (!options.from.empty()) {
    const Fingerprint file = fingerprint(options.from.string());
    start = fmt::format("{:016x}", file.fnv1a.value_or(0));
  }
  add("--from (content)", start);

  const rheo::TimeSettings& time = scene.time;
  add("--duration", number(time.duration));
  add("--frame-rate", number(time.frame_rate));
  add("--integrator", name_of(time.integrator));
  add("--step", time.step > 0.0 ? number(time.step) : "auto");
  add("--tolerance", number(time.tolerance));
  add("--accuracy", number(time.accuracy));
  add("--kernel", name_of(options.simulation.kernel));
  add("--no-energies", flag(!options.simulation.energies));
  add("--allow-unstable", flag(options.simulation.allow_unstable));
  add("--vtu", flag(options.vtu));
  if (options.command != Command::render) return text;

  const rheo::PictureSettings& picture = scene.picture;
  add("--color", name_of(picture.color));
  add("--branch", std::to_string(picture.branch));
  add("--range", picture.range_auto ? "auto" : number(picture.range[0]) + "," + number(picture.range[1]));
  add("--size", fmt::format("{}x{}", picture.size[0], picture.size[1]));
  add("--every", std::to_string(picture.every));
  add("--sheet", options.sheet ? std::to_string(*options.sheet) : "as suits the run");
  add("--backend", name_of(options.backend));
  return text;
}

std::optional<std::string> first_difference(const std::string& then, const std::string& now) {
  std::istringstream lines_then(then), lines_now(now);
  std::string a, b;
  while (std::getline(lines_then, a)) {
    const bool more = static_cast<bool>(std::getline(lines_now, b));
    if (more && a == b) continue;
    const std::size_t colon = a.find(": ");
    const std::string name = a.substr(0, colon);
    if (!more || colon == std::string::npos || !b.starts_with(name + ": ")) return name;
    return fmt::format("{} {}, not {}", name, a.substr(colon + 2), b.substr(colon + 2));
  }
  return std::nullopt;
}

}  // namespace app
