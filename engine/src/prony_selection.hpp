// How many terms a Prony series needs, and which: from a fit over a grid of times downwards, one term or part
// less at a time, the lowest Bayesian information criterion wins (prony_fit.hpp).
//
// Errors   Error::Kind::input where no sum of moduli >= 0 is better than none
#pragma once

#include "prony_problem.hpp"

namespace rheo {

// `count`: of the measured values that the rows stand for; `scatter`: the squares of their residuals that no
// fit can lessen.
PronyGuess select_terms(const PronyProblem& problem, double count, double scatter,
                        const PronyOptions& options);

}  // namespace rheo
