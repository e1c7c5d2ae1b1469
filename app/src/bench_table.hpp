// What `rheo bench` says: its table, its CSV and its advice.
#pragma once

#include <string>
#include <vector>

#include "bench_runs.hpp"

namespace app {

// integrator,kernel,threads,step,force_evaluations,seconds,error,tolerance: a row a run, with the median of
// its seconds, the largest step it took and its tolerance, if it has one.
std::string csv_of(const std::vector<Row>& rows);

// Lines for a terminal; an error below the reference's uncertainty is marked.
std::vector<std::string> table_of(const Rows& rows, const Reference& reference);

// "for 1e-6 use --integrator exponential --tolerance 1e-7 (0.03 s)": for 1e-3, 1e-6 and 1e-9, the row
// that reaches it in the least median time; of those that the runs' spread cannot tell from it the one of the
// fewest force evaluations.
std::string advice_of(const std::vector<Row>& rows, const Reference& reference);

}  // namespace app
