#include "command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <thread>

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
    "  4  a file or folder could not be read or written, memory was out, or no way to draw was found\n"
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

constexpr int most_threads = 64;
constexpr int fewest_shapes = 2;
constexpr int most_shapes = 64;
constexpr int most_branches = 1000;

// Option texts as they were typed; read after CLI11 has sorted them.
struct Texts {
  std::string scene, folder, integrator, step, tolerance, accuracy, duration, frame_rate, threads;
  std::string size, color, branch, range, backend, sheet;
  std::string kernel, csv, budget, seconds, checkpoint, from;
  std::string memory_limit, output_limit;
  bool allow_outside = false;
  bool vtu = false, force = false, resume = false, quiet = false, allow_unstable = false, no_energies = false,
       plot = false;
};

// Of a run to its end, and of the window, which has none and keeps all its books.
void add_time_options(CLI::App& command, Texts& texts) {
  const char* group = "Time (default: as the scene says)";
  const bool has_end = command.get_name() != "view";
  command
      .add_option("--integrator", texts.integrator,
                  "rk4, euler, exponential or implicit (stiff bodies); a scene's default is\nrk4, or what "
                  "its accuracy makes of it")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--step", texts.step,
                  "largest step, seconds; every interval between events and outputs is\n"
                  "divided into equal steps. auto, a scene's default: a quarter of the\n"
                  "stable limit; exponential, implicit: one step an interval")
      ->type_name("NUMBER|auto")
      ->group(group);
  command
      .add_option("--tolerance", texts.tolerance,
                  "relative error of the run, integrator exponential only, 1e-13 to 0.1;\n"
                  "default 1e-10")
      ->type_name("NUMBER")
      ->group(group);
  if (has_end) {
    command
        .add_option("--accuracy", texts.accuracy,
                    "error at the outputs, 1e-13 to 0.1: step or tolerance, and where none is\n"
                    "named the integrator too, are chosen for it; see check")
        ->type_name("NUMBER")
        ->group(group);
    command.add_option("--duration", texts.duration, "seconds to simulate")
        ->type_name("NUMBER")
        ->group(group);
    command
        .add_option("--frame-rate", texts.frame_rate,
                    "outputs per second of simulated time; a scene's default is 60")
        ->type_name("NUMBER")
        ->group(group);
  }
  command
      .add_flag("--allow-unstable", texts.allow_unstable,
                "run a step beyond the stable limit instead of refusing it")
      ->group(group);
  command
      .add_option("--kernel", texts.kernel,
                  "way to the forces: csr (assembled matrices), edge or element (by edges or\n"
                  "triangles, vectorised; lumped mass, fixed and moved nodes only, not\n"
                  "implicit) or auto, the default: the fastest that the scene allows")
      ->type_name("NAME")
      ->group(group);
  if (!has_end) return;
  command
      .add_flag("--no-energies", texts.no_energies,
                "leave history.csv's columns dissipated and work empty; steps cost less")
      ->group(group);
}

void add_output_options(CLI::App& command, Texts& texts) {
  const char* group = "Output";
  command
      .add_option("-o,--output", texts.folder, "folder of the results; default: out/ and the scene's stem")
      ->type_name("DIR")
      ->group(group);
  command
      .add_flag("--vtu", texts.vtu,
                "also write a ParaView series into DIR/vtu: u [m], v [m/s], w_lambda\nand w_mu [Pa m], "
                "strain, stress [Pa]")
      ->group(group);
  command
      .add_flag("--force", texts.force, "replace what an earlier rheo wrote into DIR; other files there stay")
      ->group(group);
  command
      .add_flag("--resume", texts.resume,
                "go on with the run in DIR that was stopped or killed, from its latest\n"
                "checkpoint: name the same scene and options")
      ->group(group);
  command
      .add_option("--checkpoint", texts.checkpoint,
                  "seconds of wall time between checkpoints, DIR/checkpoint.rheo; 0: at\n"
                  "every output; default 10. Where it is given, that of the end is kept")
      ->type_name("NUMBER|never")
      ->group(group);
  command
      .add_option("--from", texts.from,
                  "begin, at t = 0, with the shape, velocities and residual forces of this\n"
                  "checkpoint of another run on the same mesh")
      ->type_name("FILE")
      ->group(group);
  command.add_flag("--quiet", texts.quiet, "print nothing unless something fails")->group(group);
  command
      .add_option("--threads", texts.threads,
                  fmt::format("threads that compute and that encode frames, 1 to {}; default: as many\n"
                              "processors as pay. Results never depend on it",
                              most_threads))
      ->type_name("N")
      ->group(group);
}

void add_picture_options(CLI::App& command, Texts& texts) {
  const char* group = "Pictures (default: as the scene says)";
  command
      .add_option("--size", texts.size,
                  fmt::format("pixels, {};\na scene's default is 1280x720", picture_sizes()))
      ->type_name("WxH")
      ->group(group);
  command
      .add_option("--color", texts.color,
                  "w_lambda, w_mu, w (both) [Pa m], speed [m/s] or none: magnitude at\n"
                  "the nodes; a scene's default is w_lambda")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--branch", texts.branch,
                  "w_lambda, w_mu or w of one Maxwell branch, 1, 2, ...; 0: of all of them;\n"
                  "a scene's default is 0")
      ->type_name("K")
      ->group(group);
  command
      .add_option("--range", texts.range,
                  "colour range in that unit, or auto, a scene's default: that of the\nwhole sequence")
      ->type_name("LOW,HIGH|auto")
      ->group(group);
  command
      .add_option("--backend", texts.backend,
                  "auto, osmesa or egl; default auto: OSMesa where installed, else EGL")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--sheet", texts.sheet,
                  fmt::format("shapes on sheet.png, {} to {}; default: 8 to 12, as suits the run;\n"
                              "fewer in small pictures",
                              fewest_shapes, most_shapes))
      ->type_name("N")
      ->group(group);
}

// bench chooses steps and tolerances itself.
void add_bench_options(CLI::App& command, Texts& texts) {
  const auto add = [&](const char* group, const char* names, std::string& text, const char* type,
                       const std::string& description) {
    command.add_option(names, text, description)->type_name(type)->group(group);
  };
  const char* what = "What to run";
  add(what, "--budget", texts.budget, "NUMBER",
      "seconds that all of it may take, about; runs beyond it are left out and\nnamed; default 60");
  add(what, "--integrator", texts.integrator, "NAME", "this one alone; default: all");
  add(what, "--kernel", texts.kernel, "NAME",
      "csr, edge, element or auto, the default: the fastest that the scene\nallows");
  add(what, "--threads", texts.threads, "N", "threads that compute; default: as many processors as pay");
  add(what, "--duration", texts.duration, "NUMBER", "seconds to simulate; default: as the scene says");
  add(what, "--frame-rate", texts.frame_rate, "NUMBER",
      "outputs per second, where errors are measured; default: as the scene\nsays");
  const char* output = "Output";
  add(output, "-o,--output", texts.folder, "DIR",
      "folder of bench.csv, bench.png and run.json; default: out/ and the\nscene's stem and _bench");
  add(output, "--csv", texts.csv, "FILE", "the table as CSV, in the place of DIR/bench.csv");
  command
      .add_flag("--force", texts.force,
                "replace what an earlier rheo wrote into DIR, and FILE; other files stay")
      ->group(output);
  command.add_flag("--quiet", texts.quiet, "print nothing unless something fails")->group(output);
  add(output, "--size", texts.size, "WxH",
      fmt::format("pixels of bench.png, {};\ndefault: as the scene says", picture_sizes()));
  add(output, "--backend", texts.backend, "NAME", "auto, osmesa or egl, to draw with");
}

void add_plot_options(CLI::App& command, Texts& texts) {
  const char* group = "Material curves";
  command
      .add_flag("--plot", texts.plot,
                "draw the material: relaxation.csv, relaxation.png (over time),\nmoduli.csv, moduli.png "
                "(storage and loss over frequency) and, where data\nwere fitted, fit.png")
      ->group(group);
  command
      .add_option("-o,--output", texts.folder,
                  "folder of these; default: out/ and the scene's stem and _check")
      ->type_name("DIR")
      ->group(group);
  command
      .add_flag("--force", texts.force, "replace what an earlier rheo wrote into DIR; other files there stay")
      ->group(group);
  command
      .add_option("--size", texts.size,
                  fmt::format("pixels of the pictures, {};\ndefault: as the scene says", picture_sizes()))
      ->type_name("WxH")
      ->group(group);
  command.add_option("--backend", texts.backend, "auto, osmesa or egl, to draw with")
      ->type_name("NAME")
      ->group(group);
}

void add_view_options(CLI::App& command, Texts& texts) {
  const auto add = [&](const char* group, const char* names, std::string& text, const char* type,
                       const std::string& description) {
    command.add_option(names, text, description)->type_name(type)->group(group);
  };
  const char* group = "Window";
  add(group, "--size", texts.size, "WxH", "pixels of the window, 300x200 or more; default 1280x720");
  add(group, "--color", texts.color, "NAME", "w_lambda, w_mu, w (both), speed or none, to begin with");
  add(group, "--range", texts.range, "LOW,HIGH|auto", "colour range to begin with");
  add(group, "--close-after", texts.seconds, "NUMBER", "seconds after which the window closes by itself");
  add(group, "-o,--output", texts.folder, "DIR",
      "folder of saved pictures, sequences and sessions; default: out/ and the\nscene's stem and _view");
  add(group, "--threads", texts.threads, "N", "threads that compute; default: as many processors as pay");
  command.add_flag("--quiet", texts.quiet, "print nothing unless something fails")->group(group);
}

// A scene may come from a stranger.
void add_limit_options(CLI::App& command, Texts& texts) {
  const char* group = "Limits";
  command
      .add_option("--memory-limit", texts.memory_limit,
                  "GB that may be used: what needs more is refused before it is begun;\n"
                  "default: what the machine has available")
      ->type_name("NUMBER")
      ->group(group);
  command
      .add_option("--output-limit", texts.output_limit,
                  fmt::format("outputs that a run may have; default {:g}", rheo::max_outputs))
      ->type_name("NUMBER")
      ->group(group);
  command
      .add_flag("--allow-outside", texts.allow_outside,
                "let the scene read files that are neither beside nor below it")
      ->group(group);
}

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
