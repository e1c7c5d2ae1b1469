#include "command_options.hpp"

#include <fmt/format.h>

#include "option_values.hpp"

namespace app {
namespace {

// Options under one heading of a command's help.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, const char* name) : command_(command), name_(name) {}

  // type: what stands for the value in the help.
  void value(const char* names, std::string& text, const char* type, const std::string& description) const {
    command_.add_option(names, text, description)->type_name(type)->group(name_);
  }
  void flag(const char* name, bool& given, const std::string& description) const {
    command_.add_flag(name, given, description)->group(name_);
  }

 private:
  CLI::App& command_;
  const char* name_;
};

}  // namespace

void add_time_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Time (default: as the scene says)");
  const bool has_end = command.get_name() != "view";
  group.value("--integrator", texts.integrator, "NAME",
              "rk4, euler, exponential or implicit (stiff bodies); a scene's default is\nrk4, or what "
              "its accuracy makes of it");
  group.value("--step", texts.step, "NUMBER|auto",
              "largest step, seconds; every interval between events and outputs is\n"
              "divided into equal steps. auto, a scene's default: a quarter of the\n"
              "stable limit; exponential, implicit: one step an interval");
  group.value("--tolerance", texts.tolerance, "NUMBER",
              "relative error of the run, integrator exponential only, 1e-13 to 0.1;\n"
              "default 1e-10");
  if (has_end) {
    group.value("--accuracy", texts.accuracy, "NUMBER",
                "error at the outputs, 1e-13 to 0.1: step or tolerance, and where none is\n"
                "named the integrator too, are chosen for it; see check");
    group.value("--duration", texts.duration, "NUMBER", "seconds to simulate");
    group.value("--frame-rate", texts.frame_rate, "NUMBER",
                "outputs per second of simulated time; a scene's default is 60");
  }
  group.flag("--allow-unstable", texts.allow_unstable,
             "run a step beyond the stable limit instead of refusing it");
  group.value("--kernel", texts.kernel, "NAME",
              "way to the forces: csr (assembled matrices), edge or element (by edges or\n"
              "triangles, vectorised; lumped mass, fixed and moved nodes only, not\n"
              "implicit) or auto, the default: the fastest that the scene allows");
  if (!has_end) return;
  group.flag("--no-energies", texts.no_energies,
             "leave history.csv's columns dissipated and work empty; steps cost less");
}

void add_output_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Output");
  group.value("-o,--output", texts.folder, "DIR",
              "folder of the results; default: out/ and the scene's stem");
  group.flag("--vtu", texts.vtu,
             "also write a ParaView series into DIR/vtu: u [m], v [m/s], w_lambda\nand w_mu [Pa m], "
             "strain, stress [Pa]");
  group.flag("--force", texts.force, "replace what an earlier rheo wrote into DIR; other files there stay");
  group.flag("--resume", texts.resume,
             "go on with the run in DIR that was stopped or killed, from its latest\n"
             "checkpoint: name the same scene and options");
  group.value("--checkpoint", texts.checkpoint, "NUMBER|never",
              "seconds of wall time between checkpoints, DIR/checkpoint.rheo; 0: at\n"
              "every output; default 10. Where it is given, that of the end is kept");
  group.value("--from", texts.from, "FILE",
              "begin, at t = 0, with the shape, velocities and residual forces of this\n"
              "checkpoint of another run on the same mesh");
  group.flag("--quiet", texts.quiet, "print nothing unless something fails");
  group.value("--threads", texts.threads, "N",
              fmt::format("threads that compute and that encode frames, 1 to {}; default: as many\n"
                          "processors as pay. Results never depend on it",
                          most_threads));
}

void add_picture_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Pictures (default: as the scene says)");
  group.value("--size", texts.size, "WxH",
              fmt::format("pixels, {};\na scene's default is 1280x720", picture_sizes()));
  group.value("--color", texts.color, "NAME",
              "w_lambda, w_mu, w (both) [Pa m], speed [m/s] or none: magnitude at\n"
              "the nodes; a scene's default is w_lambda");
  group.value("--branch", texts.branch, "K",
              "w_lambda, w_mu or w of one Maxwell branch, 1, 2, ...; 0: of all of them;\n"
              "a scene's default is 0");
  group.value("--range", texts.range, "LOW,HIGH|auto",
              "colour range in that unit, or auto, a scene's default: that of the\nwhole sequence");
  group.value("--every", texts.every, "N",
              "a frame every N-th output, and of the last one; tables and sheet.png have\n"
              "all outputs; a scene's default is 1");
  group.value("--backend", texts.backend, "NAME",
              "auto, osmesa or egl; default auto: OSMesa where installed, else EGL");
  group.value("--sheet", texts.sheet, "N",
              fmt::format("shapes on sheet.png, {} to {}; default: 8 to 12, as suits the run;\n"
                          "fewer in small pictures",
                          fewest_shapes, most_shapes));
}

void add_bench_options(CLI::App& command, Texts& texts) {
  const OptionGroup what(command, "What to run");
  what.value("--budget", texts.budget, "NUMBER",
             "seconds that all of it may take, about; runs beyond it are left out and\nnamed; default 60");
  what.value("--integrator", texts.integrator, "NAME", "this one alone; default: all");
  what.value("--kernel", texts.kernel, "NAME",
             "csr, edge, element or auto, the default: the fastest that the scene\nallows");
  what.value("--threads", texts.threads, "N", "threads that compute; default: as many processors as pay");
  what.value("--duration", texts.duration, "NUMBER", "seconds to simulate; default: as the scene says");
  what.value("--frame-rate", texts.frame_rate, "NUMBER",
             "outputs per second, where errors are measured; default: as the scene\nsays");
  const OptionGroup output(command, "Output");
  output.value("-o,--output", texts.folder, "DIR",
               "folder of bench.csv, bench.png and run.json; default: out/ and the\nscene's stem and _bench");
  output.value("--csv", texts.csv, "FILE", "the table as CSV, in the place of DIR/bench.csv");
  output.flag("--force", texts.force,
              "replace what an earlier rheo wrote into DIR, and FILE; other files stay");
  output.flag("--quiet", texts.quiet, "print nothing unless something fails");
  output.value("--size", texts.size, "WxH",
               fmt::format("pixels of bench.png, {};\ndefault: as the scene says", picture_sizes()));
  output.value("--backend", texts.backend, "NAME", "auto, osmesa or egl, to draw with");
}

void add_plot_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Material curves");
  group.flag("--plot", texts.plot,
             "draw the material: relaxation.csv, relaxation.png (over time),\nmoduli.csv, moduli.png "
             "(storage and loss over frequency) and, where data\nwere fitted, fit.png");
  group.value("-o,--output", texts.folder, "DIR",
              "folder of these; default: out/ and the scene's stem and _check");
  group.flag("--force", texts.force, "replace what an earlier rheo wrote into DIR; other files there stay");
  group.value("--size", texts.size, "WxH",
              fmt::format("pixels of the pictures, {};\ndefault: as the scene says", picture_sizes()));
  group.value("--backend", texts.backend, "NAME", "auto, osmesa or egl, to draw with");
}

void add_view_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Window");
  group.value("--size", texts.size, "WxH", "pixels of the window, 300x200 or more; default 1280x720");
  group.value("--color", texts.color, "NAME", "w_lambda, w_mu, w (both), speed or none, to begin with");
  group.value("--range", texts.range, "LOW,HIGH|auto", "colour range to begin with");
  group.value("--close-after", texts.seconds, "NUMBER", "seconds after which the window closes by itself");
  group.value(
      "-o,--output", texts.folder, "DIR",
      "folder of saved pictures, sequences and sessions; default: out/ and the\nscene's stem and _view");
  group.value("--threads", texts.threads, "N", "threads that compute; default: as many processors as pay");
  group.flag("--quiet", texts.quiet, "print nothing unless something fails");
}

void add_limit_options(CLI::App& command, Texts& texts) {
  const OptionGroup group(command, "Limits");
  group.value("--memory-limit", texts.memory_limit, "NUMBER",
              "GB that may be used: what needs more is refused before it is begun;\n"
              "default: what the machine has available");
  group.value("--output-limit", texts.output_limit, "NUMBER",
              fmt::format("outputs that a run may have; default {:g}", rheo::max_outputs));
  group.flag("--allow-outside", texts.allow_outside,
             "let the scene read files that are neither beside nor below it");
}

}  // namespace app
