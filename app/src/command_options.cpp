#include "command_options.hpp"

#include <fmt/format.h>

#include "option_values.hpp"

namespace app {

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

}  // namespace app
