// Makes standard streams and files fail by an error instead of a signal, so that each failure can end in its
// line and exit code.
//
//   a stream that is closed   is opened on /dev/null, unwritable for standard output: no file of the run may
//                             get its number and the lines meant for the user
//   a pipe without a reader   EPIPE instead of SIGPIPE
//   a file beyond its limit   EFBIG instead of SIGXFSZ (ulimit -f)
#pragma once

namespace app {

void prepare_standard_streams();

// What the program prints and could not: the first reason, or 0.
int standard_output_failure();

}  // namespace app
