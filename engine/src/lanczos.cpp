#include "lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pseudo_random.hpp"

namespace rheo {
namespace {

constexpr double misses = 1e-8;  // probability that a lowest eigenvalue is lower than its bound
// The same of the largest frequency; and by how much of itself its square may be too large.
constexpr double frequency_misses = 1e-4;
constexpr double wanted_excess = 0.015;
constexpr int most_frequency_steps = 56;
// Residuals, of the largest diagonal entry: one that no longer counts for the largest value, and for any.
constexpr double exhausted = 1e-6, rounded = 1e-13;

// The largest eigenvalue of the tridiagonal matrix, from above, to 1e-12 of its entries: bisection by the
// signs of its pivots. (QR iteration for all of them takes longer, and does not always end where the entries
// span many decades.)
double largest_value(const Eigen::Ref<const Vector>& diagonal, const Eigen::Ref<const Vector>& off,
                     double sign) {
  const Eigen::Index k = diagonal.size();
  double low = sign * diagonal[0], high = low;
  for (Eigen::Index i = 0; i < k; ++i) {
    const double around = (i > 0 ? off[i - 1] : 0.0) + (i + 1 < k ? off[i] : 0.0);
    low = std::max(low, sign * diagonal[i]);
    high = std::max(high, sign * diagonal[i] + around);
  }
  const auto is_above_all = [&](double x) {
    double pivot = sign * diagonal[0] - x;
    for (Eigen::Index i = 1; pivot < 0.0 && i < k; ++i)
      pivot = sign * diagonal[i] - x - off[i - 1] * off[i - 1] / pivot;
    return pivot < 0.0;
  };
  const double enough = 1e-12 * std::max(std::abs(low), std::abs(high));
  while (high - low > enough) {
    const double middle = 0.5 * (low + high);
    (is_above_all(middle) ? high : low) = middle;
  }
  return high;
}

// Its eigenvector of the lowest eigenvalue, which is hardly above `value`: inverse iteration, of unit length.
Vector lowest_share(const Vector& diagonal, const Vector& off, double value) {
  const Eigen::Index k = diagonal.size();
  const double shift = value - 1e-11 * (diagonal.cwiseAbs().maxCoeff() + (k > 1 ? off.maxCoeff() : 0.0));
  Vector pivot(k), x = Vector::Ones(k);
  for (Eigen::Index i = 0; i < k; ++i)
    pivot[i] = diagonal[i] - shift - (i > 0 ? off[i - 1] * off[i - 1] / pivot[i - 1] : 0.0);
  for (int times = 0; times < 4; ++times) {
    for (Eigen::Index i = 1; i < k; ++i) x[i] -= off[i - 1] / pivot[i - 1] * x[i - 1];
    x.array() /= pivot.array();
    for (Eigen::Index i = k - 1; i > 0; --i) x[i - 1] -= off[i - 1] / pivot[i - 1] * x[i];
    x /= x.norm();
  }
  return x;
}

// (2 k - 1) sqrt(e) of lanczos.hpp.
double unlikely(double size, double probability) {
  return std::log(1.648 * std::sqrt(size) / probability);
}

}  // namespace

LanczosRun::LanczosRun(const Model& model, const ConstraintSolver& solver, const std::vector<Moduli>& moduli)
    : model_(model), solver_(solver), moduli_(moduli) {
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  std::size_t free = 0;
  for (std::size_t dof = 0; dof < model.layout.part; ++dof) free += solver.is_free(dof) ? 1 : 0;
  if (free <= solver.columns().size()) return;  // what a projection leaves is rounding
  dimension_ = static_cast<int>(free - solver.columns().size());
  target_ = Vector::Zero(static_cast<Eigen::Index>(solver.columns().size()));
  multipliers_ = target_;
  mass_times_.resize(size);

  // M q with as much of q at each node, in the norm of M, be it ever so light: the fastest modes live on the
  // smallest triangles, and what the start hardly has may be taken for exhausted.
  Vector start(size);
  std::uint64_t seed = 1;
  for (Eigen::Index i = 0; i < size; ++i) {
    start[i] = solver.is_free(static_cast<std::size_t>(i))
                   ? nearly_normal(seed) * std::sqrt(model.node_mass[i / 2])
                   : 0.0;
  }
  project(start, next_);
  beta_ = norm(next_);
  started_ = beta_ > 0.0;
  previous_ = before_ = Vector::Zero(size);
}

void LanczosRun::project(const Vector& r, Vector& out) {
  out.setZero(r.size());
  solver_.solve(r, out, target_, multipliers_);
}

double LanczosRun::norm(const Vector& x) {
  model_.multiply_mass(x.data(), mass_times_.data());
  return std::sqrt(x.dot(mass_times_));
}

Eigen::Map<const Vector> LanczosRun::diagonal() const {
  return {diagonal_.data(), static_cast<Eigen::Index>(diagonal_.size())};
}

Eigen::Map<const Vector> LanczosRun::off_diagonal() const {
  return {off_.data(), static_cast<Eigen::Index>(off_.size())};
}

void LanczosRun::step() {
  before_.swap(previous_);
  previous_ = next_ / beta_;
  if (!diagonal_.empty()) off_.push_back(beta_);
  mass_times_ /= beta_;  // of previous_ now
  model_.stiffness(moduli_, previous_, force_);
  project(force_, next_);
  const double alpha = next_.dot(mass_times_);
  next_ -= alpha * previous_ + (off_.empty() ? 0.0 : beta_) * before_;
  diagonal_.push_back(alpha);
  largest_ = std::max(largest_, std::abs(alpha));
  beta_ = norm(next_);
  if (!is_exhausted(exhausted) || !(beta_ > 0.0)) return;
  // What is left may be rounding in good part, which the constraints do not hold.
  const Vector left = mass_times_;
  project(left, next_);
  beta_ = norm(next_);
}

RitzBound largest_frequency(const Model& model, const ConstraintSolver& solver,
                            const std::vector<Moduli>& moduli) {
  LanczosRun run(model, solver, moduli);
  if (!run.has_started()) return {};
  const double chance = unlikely(static_cast<double>(model.layout.part), frequency_misses);
  // Largest eigenvalue / largest Ritz value - 1 after k steps.
  const auto excess = [&](int k) {
    const double e = std::pow(chance / (2 * k - 1), 2);
    return e < 1.0 ? e / (1.0 - e) : std::numeric_limits<double>::infinity();
  };
  bool is_whole = false;
  while (!is_whole && run.steps() < most_frequency_steps && !(excess(run.steps()) <= wanted_excess)) {
    run.step();
    // As many steps as there is space for; where rounding has begun it anew, the ends were found before.
    is_whole = run.is_exhausted(exhausted) || run.steps() == run.dimension();
  }
  const double theta = std::max(0.0, largest_value(run.diagonal(), run.off_diagonal(), 1.0));
  return {std::sqrt((1.0 + (is_whole ? exhausted : excess(run.steps()))) * theta), run.steps()};
}

LowestValue lowest_value(const Model& model, const ConstraintSolver& solver,
                         const std::vector<Moduli>& moduli, double shift, int most_steps) {
  LanczosRun run(model, solver, moduli);
  LowestValue result;
  const double chance = unlikely(static_cast<double>(model.layout.part), misses);
  double before = std::numeric_limits<double>::infinity();
  for (bool goes_on = run.has_started(); goes_on;) {
    run.step();
    goes_on = !run.is_exhausted(rounded);
    const int k = run.steps();
    const double resolved = chance / (2 * k - 1);
    if (goes_on && k < most_steps && (k % 8 != 0 || resolved > 0.5)) continue;
    const double lowest = -largest_value(run.diagonal(), run.off_diagonal(), -1.0);
    const double highest = largest_value(run.diagonal(), run.off_diagonal(), 1.0);
    const double spread = highest - lowest;
    const double rounding = 2e-12 * std::max(std::abs(lowest), std::abs(highest));
    result.ritz = lowest;
    result.diagonal = run.diagonal();
    result.off_diagonal = run.off_diagonal();
    // Of the whole spread, of which the Ritz values may miss as much at the other end.
    const double missed = resolved * resolved / std::max(1.0 - 2.0 * resolved * resolved, 0.5);
    result.bound = lowest - rounding - (goes_on ? missed * spread : run.beta());
    // Half of what there is, which leaves something for the neighbours.
    if (result.bound + shift > 0.5 * (lowest + shift) && lowest + shift > 0.0) break;
    // A negative one is a witness whatever its residual, and a better one where it is near.
    if (lowest + shift < 0.0 && before - lowest <= 0.02 * std::abs(lowest + shift)) break;
    before = lowest;
    if (k == most_steps) break;
  }
  return result;
}

Vector lowest_vector(const Model& model, const ConstraintSolver& solver, const std::vector<Moduli>& moduli,
                     const LowestValue& found) {
  const Eigen::Index steps = found.diagonal.size();
  const Vector share = lowest_share(found.diagonal, found.off_diagonal, found.ritz);
  LanczosRun run(model, solver, moduli);
  Vector x = Vector::Zero(static_cast<Eigen::Index>(model.layout.part));
  for (Eigen::Index k = 0; k < steps; ++k) {
    run.step();
    x += share[k] * run.vector();
  }
  return x;
}

}  // namespace rheo
