// The program from its command line to its exit code.
//
// Errors   none leave here: each becomes one line on standard error, "rheo: ...", and an exit code
// (failure.hpp)
#pragma once

namespace app {

class Failure;

int run_program(int argc, char** argv);

// Tells the failure and ends the process where it is, without destructors: for where a library is of no use
// any more and cannot be left in order.
[[noreturn]] void end_at_once(const Failure& failure);

}  // namespace app
