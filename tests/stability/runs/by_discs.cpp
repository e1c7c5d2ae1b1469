#include "stability/runs/by_discs.hpp"

#include <cmath>
#include <utility>

#include "range_step.hpp"
#include "stability/scene_parts.hpp"

namespace rheo::test {

ByDiscs euler_by_discs(Scene scene) {
  scene.time.integrator = IntegratorKind::euler;
  scene.time.step = 0.0;
  const Parts parts(scene);
  ByDiscs result;
  result.safe = stable_step(parts.spectrum, IntegratorKind::euler);
  if (std::isinf(result.safe) || !stable_step_is_bound(parts.spectrum, IntegratorKind::euler)) return result;
  result.truth = TrueSpectrum(scene).limit(IntegratorKind::euler);
  result.counts = result.truth.determined() && result.truth.low > 0.0;
  if (!result.counts) return result;
  const DiscSearch discs{
      .eigenvalues = [&] { return NearbyEigenvalues(scene.mesh, parts.model, *parts.solver); }};
  const RangeStep found =
      range_step(parts.model, *parts.solver, parts.spectrum, IntegratorKind::euler, result.safe, &discs);
  Spectrum spectrum = parts.spectrum;
  spectrum.euler_step = found.step;
  spectrum.near_euler_step = found.near_step;
  result.is_near = found.near_step > 0.0;
  result.predicted = stable_step(spectrum, IntegratorKind::euler);
  return result;
}

}  // namespace rheo::test
