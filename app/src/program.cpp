#include "program.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "bench.hpp"
#include "check.hpp"
#include "command_line.hpp"
#include "failure.hpp"
#include "rheo/error.hpp"
#include "runner.hpp"
#include "standard_streams.hpp"
#include "view/view.hpp"

namespace app {
namespace {

// One line whatever a path or a library's text contains.
int report(ExitCode code, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  std::fflush(stdout);
  // Whether or not somebody can read it.
  const std::string line = "rheo: " + message + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
  return static_cast<int>(code);
}

void run_command(int argc, char** argv) {
  const std::optional<Options> options = read_command_line(argc, argv);
  if (options) {
    if (options->command == Command::check)
      check_scene(*options);
    else if (options->command == Command::bench)
      bench_scene(*options);
    else if (options->command == Command::view)
      view_scene(*options);
    else
      run_scene(*options);
  }
  if (const int reason = standard_output_failure(); reason != 0)
    throw Failure(ExitCode::file, fmt::format("cannot write to standard output: {}", std::strerror(reason)));
}

}  // namespace

void end_at_once(const Failure& failure) {
  const int code = report(failure.code(), failure.what());
  std::fflush(stderr);
  std::_Exit(code);
}

int run_program(int argc, char** argv) {
  prepare_standard_streams();
  try {
    run_command(argc, argv);
    return static_cast<int>(ExitCode::done);
  } catch (const Failure& failure) {
    return report(failure.code(), failure.what());
  } catch (const rheo::Error& error) {
    return report(error.kind() == rheo::Error::Kind::input ? ExitCode::usage : ExitCode::file, error.what());
  } catch (const std::bad_alloc&) {
    return report(ExitCode::file, "out of memory: the mesh or the picture is too large for this machine");
  } catch (const std::exception& error) {
    // The renderer's errors and the file system's: a missing library, a driver's limit, a full disk.
    return report(ExitCode::file, error.what());
  }
}

}  // namespace app
