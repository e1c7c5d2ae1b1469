// Whether the shell's limit of addresses (ulimit -v) leaves room to draw: libraries that draw map many, and
// some of them end the program where they get none.
//
// Units    bytes
// Errors   require_drawing_room: Failure(file), with what it takes and the limit
#pragma once

namespace app {

// Infinite where there is no limit.
double address_space_limit();

// What drawing maps.
double drawing_addresses();

// Before a context is opened.
void require_drawing_room();

}  // namespace app
