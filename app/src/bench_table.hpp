// What `rheo bench` says: its table, its CSV and its advice.
#pragma once

#include <string>
#include <vector>

#include "bench_runs.hpp"

namespace app {

// integrator,kernel,threads,step,force_evaluations,seconds,error: a row a run; step is the largest that was
// taken.
std::string csv_of(const std::vector<Row>& rows);

// Lines for a terminal; an error below the reference's uncertainty is marked.
std::vector<std::string> table_of(const Rows& rows, const Reference& reference);

// "for 1e-6 use --integrator exponential --tolerance 1e-7 (0.03 s)": the fastest row that reaches 1e-3,
// 1e-6, 1e-9.
std::string advice_of(const std::vector<Row>& rows, const Reference& reference);

}  // namespace app
