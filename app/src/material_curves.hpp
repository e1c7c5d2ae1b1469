// The curves of a scene's material: relaxation functions over time, complex moduli over frequency.
//
// relaxation.csv: t,r_lambda,r_mu [s, Pa], the first row at t = 0; what a viscous part adds is at t = 0 only
// and not in it. moduli.csv: frequency,lambda_storage,lambda_loss,mu_storage,mu_loss [Hz, Pa]. 17 significant
// digits. Both axes are logarithmic and reach from a hundredth of the shortest relaxation time to ten times
// the longest, the frequencies belong to a hundred times as well; measured data lie within. Without a
// relaxation time they reach around the scene's duration.
#pragma once

#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace app {

struct MaterialCurves {
  std::vector<double> t, r_lambda, r_mu;
  std::vector<double> frequency, lambda_storage, lambda_loss, mu_storage, mu_loss;
};

MaterialCurves curves_of(const rheo::Scene& scene);

std::string relaxation_csv(const MaterialCurves& curves);
std::string moduli_csv(const MaterialCurves& curves);

// Measured points and the fitted series as a curve through all of their range; storage and loss of a sweep,
// of a relaxation function the first only. Points at t = 0 are left out, and of many points some hundreds are
// shown.
struct FitCurves {
  bool sweep = false;
  std::vector<double> data_x, data, data_loss;
  std::vector<double> x, fit, fit_loss;
};

FitCurves fit_curves_of(const rheo::MeasuredMaterial& measured);

}  // namespace app
