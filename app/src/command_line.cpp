#include "command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <thread>

#include "command_options.hpp"
#include "failure.hpp"
#include "nearest.hpp"
#include "option_values.hpp"

namespace app {
namespace {

constexpr const char* about =
    "rheo simulates rheological soft bodies: flat meshes of Maxwell triangles, described by a scene file "
    "(TOML)\n"
    "in SI units.";

constexpr const char* exit_codes =
    "Exit codes:\n"
    "  0  done\n"
    "  2  wrong usage or scene: nothing was written\n"
    "  3  the simulation diverged: when, where and the stable step are named\n"
    "  4  a file or folder could not be read or written, memory was out, no way to draw was found, or the\n"
    "     display went away under the window\n"
    "  130, 143  a run was stopped by SIGINT (Ctrl-C), SIGTERM: --resume goes on with it\n"
    "A failure writes one line to standard error that says what to do.\n";

constexpr const char* examples =
    "Examples:\n"
    "  rheo check beam.toml\n"
    "  rheo check beam.toml --plot -o out/material\n"
    "  rheo run beam.toml -o out/beam --vtu\n"
    "  rheo render beam.toml --color w_mu --size 1920x1080\n"
    "  rheo run beam.toml --integrator euler --step 1e-4 --force\n"
    "  rheo run beam.toml --integrator euler --step 1e-4 --resume\n"
    "  rheo bench beam.toml --csv beam.csv\n"
    "  rheo view beam.toml --color w_mu\n";

CLI::App* add_command(CLI::App& program, Texts& texts, const std::string& name,
                      const std::string& description) {
  CLI::App* command = program.add_subcommand(name, description);
  command->add_option("SCENE", texts.scene, "scene file (TOML)")->required()->type_name("");
  if (name != "bench") add_time_options(*command, texts);
  add_limit_options(*command, texts);
  command->group("Commands");
  command->footer(fmt::format("{}\n{}", examples, exit_codes));
  return command;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// The first word must be a command; CLI11 alone would complain about the words after it.
void check_first_word(const std::vector<std::string>& words) {
  if (words.size() < 2)
    throw Failure(ExitCode::usage,
                  "no command: use run, render, view, check or bench with a scene file (see rheo --help)");
  const std::string& word = words[1];
  const std::vector<std::string> commands{"run", "render", "view", "check", "bench"};
  if (word.starts_with('-') || std::ranges::find(commands, word) != commands.end()) return;
  const std::string close = nearest(word, commands);
  throw Failure(ExitCode::usage,
                fmt::format("unknown command '{}': must be run, render, view, check or bench{}", word,
                            close.empty() ? "" : fmt::format("; did you mean {}?", close)));
}

[[noreturn]] void refuse_extra(const std::string& extra, const CLI::App* command) {
  const std::string option = extra.substr(0, extra.find('='));
  if (command == nullptr)
    throw Failure(ExitCode::usage,
                  fmt::format("option '{}' comes after the command: rheo COMMAND SCENE {} (see rheo "
                              "--help)",
                              option, option));
  const std::string help = fmt::format("see rheo {} --help", command->get_name());
  if (!extra.starts_with('-'))
    throw Failure(ExitCode::usage,
                  fmt::format("unexpected '{}': one scene file at a time ({})", extra, help));
  const std::string close = nearest(option, option_names(*command));
  throw Failure(ExitCode::usage,
                fmt::format("unknown option '{}'{} ({})", option,
                            close.empty() ? "" : fmt::format(", did you mean {}?", close), help));
}

// CLI11's complaint in the words of this program.
[[noreturn]] void refuse_parse(const CLI::ParseError& error, const CLI::App* command) {
  const std::string help = command ? fmt::format("rheo {} --help", command->get_name()) : "rheo --help";
  std::string text = error.what();
  if (error.get_name() == "RequiredError") text = "SCENE is missing: name a scene file";
  if (error.get_name() == "ArgumentMismatch") {
    const std::string option = text.substr(0, text.find(':'));
    text = option +
           (text.find("At Most") != std::string::npos ? ": given more than once" : ": its value is missing");
  }
  throw Failure(ExitCode::usage, fmt::format("{} (see {})", text, help));
}

// CLI11 takes an option's name for the value of the option before it, or blames a later word.
void check_values(const std::vector<std::string>& words, const CLI::App& command) {
  const std::string help = fmt::format("see rheo {} --help", command.get_name());
  for (std::size_t i = 2; i < words.size() && words[i] != "--"; ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    if (!name.starts_with('-')) continue;
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) continue;
    const bool is_flag = option->get_items_expected_max() == 0;
    if (is_flag && name != words[i])
      throw Failure(ExitCode::usage, fmt::format("{} takes no value ({})", name, help));
    if (is_flag || name != words[i] || i + 1 == words.size()) continue;
    const std::string next = words[i + 1].substr(0, words[i + 1].find('='));
    if (next.starts_with('-') && command.get_option_no_throw(next) != nullptr)
      throw Failure(ExitCode::usage, fmt::format("{}: its value is missing: '{}' is an option ({})", name,
                                                 words[i + 1], help));
    ++i;
  }
}

Options read_values(const Texts& texts, const CLI::App& command) {
  Options options;
  const std::string& name = command.get_name();
  options.command = name == "run"      ? Command::run
                    : name == "render" ? Command::render
                    : name == "view"   ? Command::view
                    : name == "check"  ? Command::check
                                       : Command::bench;
  if (texts.scene.empty()) throw Failure(ExitCode::usage, "SCENE '': must be the path of a scene file");
  options.scene = texts.scene;
  const auto given = [&](const char* option) {
    const CLI::Option* found = command.get_option_no_throw(option);
    return found != nullptr && found->count() > 0;
  };
  if (given("--integrator")) options.integrator = integrator_kind("--integrator", texts.integrator);
  if (given("--step")) options.step = {step_value("--step", texts.step), texts.step};
  if (given("--tolerance")) options.tolerance = tolerance_value("--tolerance", texts.tolerance);
  if (given("--accuracy")) options.accuracy = accuracy_value("--accuracy", texts.accuracy);
  for (const char* other : {"--step", "--tolerance"}) {
    if (options.accuracy && given(other))
      throw Failure(ExitCode::usage,
                    fmt::format("--accuracy '{}' and {}: one of them decides, leave out the other",
                                texts.accuracy, other));
  }
  if (given("--duration"))
    options.duration = {positive_number("--duration", texts.duration, "seconds"), texts.duration};
  if (given("--frame-rate"))
    options.frame_rate = {positive_number("--frame-rate", texts.frame_rate, "outputs per second"),
                          texts.frame_rate};
  if (given("--memory-limit"))
    options.read.memory = 1e9 * positive_number("--memory-limit", texts.memory_limit, "GB");
  options.simulation.memory = options.read.memory;
  if (given("--output-limit"))
    options.read.outputs = positive_number("--output-limit", texts.output_limit, "outputs");
  if (texts.allow_outside) options.read.outside = rheo::OutsideFiles::allowed;
  options.simulation.allow_unstable = texts.allow_unstable;
  options.simulation.energies = !texts.no_energies;
  if (given("--kernel")) options.simulation.kernel = kernel_choice("--kernel", texts.kernel);

  options.folder = std::filesystem::path("out") / options.scene.stem();
  // Apart from the results of run and render, which --force would take for an earlier run's.
  if (options.command == Command::bench) options.folder += "_bench";
  if (options.command == Command::check) options.folder += "_check";
  if (options.command == Command::view) options.folder += "_view";
  if (given("--close-after"))
    options.close_after = positive_number("--close-after", texts.seconds, "seconds");
  if (given("--csv")) {
    if (texts.csv.empty()) throw Failure(ExitCode::usage, "--csv '': must be the path of a file");
    options.csv = texts.csv;
  }
  if (given("--budget")) options.budget = positive_number("--budget", texts.budget, "seconds");
  if (given("--output")) {
    if (texts.folder.empty()) throw Failure(ExitCode::usage, "--output '': must be the path of a folder");
    options.folder = texts.folder;
  }
  options.vtu = texts.vtu;
  options.plot = texts.plot;
  for (const char* other : {"--output", "--force", "--size", "--backend"}) {
    if (options.command == Command::check && given(other) && !options.plot)
      throw Failure(ExitCode::usage,
                    fmt::format("{} goes with --plot: without it check writes and draws nothing", other));
  }
  options.force = texts.force;
  options.resume = texts.resume;
  if (options.resume && options.force)
    throw Failure(ExitCode::usage,
                  "--resume and --force: one goes on with the run in DIR, the other replaces it");
  if (given("--checkpoint")) {
    options.checkpoint_seconds = checkpoint_interval("--checkpoint", texts.checkpoint);
    options.keeps_checkpoint = std::isfinite(options.checkpoint_seconds);
  }
  if (given("--from")) {
    if (texts.from.empty()) throw Failure(ExitCode::usage, "--from '': must be the path of a checkpoint");
    options.from = texts.from;
  }
  options.quiet = texts.quiet;
  options.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 4);
  if (given("--threads")) {
    options.threads = whole_number("--threads", texts.threads, 1, most_threads);
    options.simulation.threads = options.threads;
  }

  if (given("--size")) options.size = picture_size("--size", texts.size);
  if (given("--color")) options.color = color_by("--color", texts.color);
  if (given("--branch")) options.branch = whole_number("--branch", texts.branch, 0, most_branches);
  if (given("--range")) options.range = color_range("--range", texts.range);
  if (given("--every")) options.every = whole_number("--every", texts.every, 1, rheo::most_every);
  if (given("--backend")) options.backend = draw_backend("--backend", texts.backend);
  if (given("--sheet")) options.sheet = whole_number("--sheet", texts.sheet, fewest_shapes, most_shapes);
  return options;
}

}  // namespace

std::optional<Options> read_command_line(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  check_first_word(words);

  CLI::App program(about, "rheo");
  program.set_version_flag("--version", fmt::format("rheo {}", RHEO_VERSION));
  program.get_formatter()->column_width(34);
  program.get_formatter()->label("SUBCOMMAND", "COMMAND");
  program.footer(
      fmt::format("rheo COMMAND --help lists the options of a command.\n\n{}\n{}", examples, exit_codes));
  Texts texts;
  CLI::App* run = add_command(program, texts, "run", "simulate; writes state.csv, history.csv and run.json");
  CLI::App* render = add_command(program, texts, "render",
                                 "simulate and draw: run's files, frames, sheet.png and residual.png");
  CLI::App* view =
      add_command(program, texts, "view", "the window: push, grab and release the body in real time");
  add_view_options(*view, texts);
  CLI::App* check = add_command(program, texts, "check",
                                "read the scene; print sizes, stable steps and a cost forecast; no run");
  add_plot_options(*check, texts);
  add_output_options(*run, texts);
  add_output_options(*render, texts);
  add_picture_options(*render, texts);
  CLI::App* bench = add_command(program, texts, "bench",
                                "run the scene over integrators and steps; run time against error");
  add_bench_options(*bench, texts);

  const auto chosen = [&]() -> const CLI::App* {
    const auto commands = program.get_subcommands();
    return commands.empty() ? nullptr : commands.front();
  };
  for (const CLI::App* command : {run, render, view, check, bench})
    if (command->get_name() == words[1]) check_values(words, *command);
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", program.help());
    return std::nullopt;
  } catch (const CLI::CallForVersion& version) {
    fmt::print("{}\n", version.what());
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (const auto before = program.remaining(false); !before.empty()) refuse_extra(before.front(), nullptr);
    if (const auto extras = program.remaining(true); !extras.empty()) refuse_extra(extras.front(), chosen());
    refuse_parse(error, chosen());
  }
  if (!chosen())
    throw Failure(ExitCode::usage,
                  "no command: use run, render, view, check or bench with a scene file (see rheo --help)");
  Options options = read_values(texts, *chosen());
  options.words = words;
  return options;
}

}  // namespace app
