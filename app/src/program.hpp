// The program from its command line to its exit code.
//
// Errors   none leave here: each becomes one line on standard error, "rheo: ...", and an exit code
// (failure.hpp)
#pragma once

namespace app {

int run_program(int argc, char** argv);

}  // namespace app
