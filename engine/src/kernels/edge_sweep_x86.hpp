// Sweeps (edge_sweep.hpp) in AVX2 and AVX-512 code; only for processors that have the instructions.
//
// Two nodes of a run at a time: an edge of each lies beside the other's in memory (edge_form.hpp), and what
// `mixed` holds for several edges is read once and spread by permutations: on these processors the loads are
// what limits a sweep (two a cycle).
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#ifndef RHEO_X86_SWEEPS
#define RHEO_X86_SWEEPS 1
#endif

#include "kernels/edge_sweep.hpp"

namespace rheo {

using Sweep = void(const EdgeForm& form, const double* inverse_mass, const SweepMaterial& m, double h,
                   const SweepArrays& a, std::int32_t first_run, std::int32_t last_run);

Sweep sweep_avx2, sweep_avx512;                    // Level::ready
Sweep sweep_summed_avx2, sweep_summed_avx512;      // Level::summed
Sweep sweep_combined_avx2, sweep_combined_avx512;  // two numbers a node

}  // namespace rheo

#endif
