// What benchmarks report beside their time, the same everywhere.
//
// time/tri   seconds of an iteration over its triangles and steps; the console writes it as "7.4ns"
// label      "hash ...", 16 digits: the bits of the state after a fixed number of steps, so that a fast wrong
//            answer shows (rheo/fingerprint.hpp; the same numbers in another order have another hash). Where
//            the error is known, that too: the console writes a counter of 1e-8 as "10n"
#pragma once

#include <benchmark/benchmark.h>

#include <cinttypes>
#include <cstdio>
#include <span>
#include <string>

#include "rheo/fingerprint.hpp"
#include "rheo/simulation.hpp"

namespace bench {

// A counter of seconds: an iteration's over `parts`.
inline benchmark::Counter seconds_over(double parts) {
  return {parts, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}

// `parts`: triangles times steps of an iteration.
inline void report_time(benchmark::State& state, double parts) {
  state.counters["time/tri"] = seconds_over(parts);
}

class StateHash {
 public:
  StateHash& add(std::span<const double> numbers) {
    for (const double x : numbers) fingerprint_.add(x);
    return *this;
  }
  StateHash& add(const rheo::Simulation& simulation) {  // as run.json's state_hash
    return add(simulation.u()).add(simulation.v()).add(simulation.w_lambda()).add(simulation.w_mu());
  }
  void report(benchmark::State& state) const { state.SetLabel(text()); }
  void report(benchmark::State& state, double error) const {
    state.counters["error"] = error;
    char words[32];
    std::snprintf(words, sizeof words, ", error %.1e", error);
    state.SetLabel(text() + words);
  }

 private:
  std::string text() const {
    char words[32];
    std::snprintf(words, sizeof words, "hash %016" PRIx64, fingerprint_.value());
    return words;
  }
  rheo::Fingerprint fingerprint_;
};

}  // namespace bench
