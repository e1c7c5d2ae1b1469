#include "numerical_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "lanczos.hpp"

namespace rheo {
namespace {

constexpr int most_steps = 400;  // of a Lanczos run
// u and v are looked for up to this: where the numbers that count are of size 1.
constexpr double largest_multiplier = 1e3;
// Of the distance from a pole, and from 0, how far apart numbers may be: 1 / (1 + r z) and z^2 bend by a
// fourth of its square.
constexpr double near_by = 0.1;

using Point = std::array<double, 2>;

// The part of a convex polygon where a u + b v >= c.
void clip(std::vector<Point>& polygon, double a, double b, double c) {
  std::vector<Point> kept;
  kept.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const double at_p = a * p[0] + b * p[1] - c, at_q = a * q[0] + b * q[1] - c;
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) {
      const double t = at_p / (at_p - at_q);
      kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
  }
  polygon.swap(kept);
}

struct Direction {
  double u = 1.0, v = 0.0, least = 0.0;  // of unit length, and the smallest u Re + v Im of some points
};

// For points in some half plane: the direction with the largest `least`, or with the largest part of the
// largest.
Direction best_direction(const std::vector<std::complex<double>>& points, NumericalRange::Clearest clearest) {
  // The points' angles from one of them, whose opposite none has.
  double low = 0.0, high = 0.0;
  for (const std::complex<double> p : points) {
    const double angle = std::arg(p / points.front());
    low = std::min(low, angle);
    high = std::max(high, angle);
  }
  const double first = std::arg(points.front());
  const auto at = [&](double angle) {
    Direction d{std::cos(angle), std::sin(angle), std::numeric_limits<double>::infinity()};
    double most = 0.0;
    for (const std::complex<double> p : points) {
      const double value = d.u * p.real() + d.v * p.imag();
      d.least = std::min(d.least, value);
      most = std::max(most, value);
    }
    return std::pair(d, clearest == NumericalRange::Clearest::distance ? d.least : d.least / most);
  };
  // All are positive between the normals of the first and of the last.
  double left = first + high - 0.5 * std::numbers::pi,
         right = first + low + 0.5 * std::numbers::pi;  // no other maximum between than the largest
  for (int k = 0; k < 60; ++k) {
    const double a = left + (right - left) / 3.0, b = right - (right - left) / 3.0;
    (at(a).second < at(b).second ? left : right) = at(a).second < at(b).second ? a : b;
  }
  return at(0.5 * (left + right)).first;
}

}  // namespace

NumericalRange::NumericalRange(const Model& model, const ConstraintSolver& solver)
    : model_(model), solver_(solver), poles_{0.0} {
  for (std::size_t r = 0; r < model.patches.size(); ++r) {
    const Patch& patch = model.patches[r];
    const std::vector<Relaxation> relaxations = relaxations_of(patch.material);
    for (const Modulus modulus : {Modulus::lambda, Modulus::mu}) {
      if (!patch.has(modulus)) continue;
      const auto of = [&](const Moduli& m) { return modulus == Modulus::lambda ? m.lambda : m.mu; };
      Term term{r, modulus, {}, of(patch.material.viscous), 0.0};
      for (const Relaxation& each : relaxations)
        if (of(each.moduli) > 0.0) {
          term.springs.emplace_back(of(each.moduli), each.rate);
          if (each.rate > 0.0) poles_.emplace_back(-1.0 / each.rate);
        }
      terms_.push_back(std::move(term));
    }
  }
  const auto dims = static_cast<Eigen::Index>(terms_.size());
  std::vector<double> bounds;
  for (Eigen::Index m = 0; m < dims; ++m) {
    bounds.push_back(lowest_of(0.0, -Vector::Unit(dims, m), 0.0));
    terms_[static_cast<std::size_t>(m)].largest = std::max(-bounds.back(), 0.0);
  }
  for (Eigen::Index m = 0; m < dims; ++m) {
    const double largest = terms_[static_cast<std::size_t>(m)].largest;
    if (largest > 0.0) positive_.push_back(signs_of(largest, -Vector::Unit(dims, m)) / largest);
  }
}

NumericalRange::Coefficients NumericalRange::coefficients(std::complex<double> z) const {
  Coefficients c;
  for (const Term& term : terms_) {
    std::complex<double> sum = term.dashpot;
    for (const auto& [modulus, rate] : term.springs) sum += modulus * (z / (1.0 + rate * z));
    c.push_back(z * sum);
  }
  return c;
}

Vector NumericalRange::signs_of(double alpha, const Vector& beta) const {
  Vector rows(1 + beta.size());
  rows[0] = alpha;
  for (Eigen::Index m = 0; m < beta.size(); ++m) {
    const auto k = static_cast<std::size_t>(m);
    // lambda J_lambda + mu J_mu = lambda' (J_mu - J_lambda) + ... : mu >= 0 and lambda + mu >= 0 will do.
    const bool with_mu = terms_[k].modulus == Modulus::lambda && k + 1 < terms_.size() &&
                         terms_[k + 1].region == terms_[k].region;
    rows[1 + m] = (beta[m] + (with_mu ? beta[m + 1] : 0.0)) * terms_[k].largest;
  }
  return rows;
}

NumericalRange::Rows NumericalRange::rows_of(const Coefficients& c) const {
  const auto dims = static_cast<Eigen::Index>(c.size());
  Vector re(dims), im(dims);
  for (Eigen::Index m = 0; m < dims; ++m) {
    re[m] = c[static_cast<std::size_t>(m)].real();
    im[m] = c[static_cast<std::size_t>(m)].imag();
  }
  Rows rows{signs_of(1.0, re), signs_of(0.0, im)};
  const double scale = std::max(rows.re.cwiseAbs().maxCoeff(), rows.im.cwiseAbs().maxCoeff());
  rows.re /= scale;
  rows.im /= scale;
  return rows;
}

void NumericalRange::add_witnesses(const Coefficients& c, std::vector<std::complex<double>>& points) const {
  points.emplace_back(1.0);
  for (const Vector& q : quotients_) {
    std::complex<double> sum = 1.0;
    for (std::size_t m = 0; m < c.size(); ++m) sum += c[m] * q[static_cast<Eigen::Index>(m)];
    points.push_back(sum);
  }
}

bool NumericalRange::excludes(std::span<const std::complex<double>> z) const {
  double apart = 0.0;
  for (const std::complex<double> each : z) apart = std::max(apart, std::abs(each - z.front()));
  for (const std::complex<double> pole : poles_)
    if (apart > near_by * std::abs(z.front() - pole)) return false;
  std::vector<Rows> rows;
  for (const std::complex<double> each : z) rows.push_back(rows_of(coefficients(each)));
  const auto reaches = [&](const Vector* least) {
    ++trials_;
    constexpr double b = largest_multiplier;
    std::vector<Point> polygon{{-b, -b}, {b, -b}, {b, b}, {-b, b}};
    for (const Rows& each : rows) {
      for (Eigen::Index i = 0; i < each.re.size() && !polygon.empty(); ++i) {
        const double wanted = least != nullptr ? (*least)[i] : 0.0;
        // Positive definite, not only nowhere negative: alpha makes it so.
        const double more = i == 0 ? 1e-12 * std::max(each.re[0], std::abs(wanted)) : 0.0;
        clip(polygon, each.re[i], each.im[i], wanted + more);
      }
    }
    return !polygon.empty();
  };
  return reaches(nullptr) ||
         std::ranges::any_of(positive_, [&](const Vector& least) { return reaches(&least); });
}

bool NumericalRange::excludes_slower(std::complex<double> z) const {
  const Rows rows = rows_of(coefficients(z));
  for (Eigen::Index i = 1; i < rows.im.size(); ++i) {
    const bool is_stiff = terms_[static_cast<std::size_t>(i - 1)].largest > 0.0;
    if (is_stiff && !(rows.im[i] > 0.0)) return false;
  }
  return true;
}

bool NumericalRange::includes(std::span<const std::complex<double>> z) const {
  std::vector<std::complex<double>> points;
  for (const std::complex<double> each : z) add_witnesses(coefficients(each), points);
  std::vector<double> angles;
  for (const std::complex<double>& point : points) {
    if (point == 0.0) return true;
    angles.push_back(std::arg(point));
  }
  std::ranges::sort(angles);
  double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap <= std::numbers::pi;
}

void NumericalRange::look_at(std::complex<double> z, Clearest clearest) {
  const Coefficients c = coefficients(z);
  std::vector<std::complex<double>> points;
  add_witnesses(c, points);
  const auto [u, v, least] = best_direction(points, clearest);
  Vector beta(static_cast<Eigen::Index>(c.size()));
  for (std::size_t m = 0; m < c.size(); ++m)
    beta[static_cast<Eigen::Index>(m)] = u * c[m].real() + v * c[m].imag();
  // beta J - bound is positive, be it more or less than what was asked.
  const double bound = lowest_of(u, beta, 0.8 * least);
  Vector rows = signs_of(-bound, beta);
  const double unit = rows_of(c).re[0];  // 1 / what rows there are divided by
  positive_.push_back(unit * rows);
  // What H has more than that, half of it to the other rows: no J_m is larger than its largest.
  const double spare = u + bound;
  if (spare > 0.0) {
    rows[0] += 0.5 * spare;
    rows.tail(rows.size() - 1).array() -= 0.5 * spare / static_cast<double>(rows.size() - 1);
    positive_.push_back(unit * rows);
  }
}

double NumericalRange::lowest_of(double alpha, const Vector& beta, double expected) {
  std::vector<Moduli> moduli(model_.patches.size());
  for (std::size_t m = 0; m < terms_.size(); ++m) {
    Moduli& own = moduli[terms_[m].region];
    (terms_[m].modulus == Modulus::lambda ? own.lambda : own.mu) = beta[static_cast<Eigen::Index>(m)];
  }
  const LowestValue lowest = lowest_value(model_, solver_, moduli, alpha, most_steps);
  products_ += static_cast<int>(lowest.diagonal.size());
  if (lowest.diagonal.size() == 0 || lowest.ritz + alpha > expected) return lowest.bound;
  const Vector x = lowest_vector(model_, solver_, moduli, lowest);
  products_ += static_cast<int>(lowest.diagonal.size() + terms_.size());
  Vector mass_times(x.size());
  model_.multiply_mass(x.data(), mass_times.data());
  const double norm = x.dot(mass_times);
  Vector quotient(static_cast<Eigen::Index>(terms_.size()));
  for (std::size_t m = 0; m < terms_.size(); ++m) {
    std::fill(moduli.begin(), moduli.end(), Moduli{});
    Moduli& own = moduli[terms_[m].region];
    (terms_[m].modulus == Modulus::lambda ? own.lambda : own.mu) = 1.0;
    quotient[static_cast<Eigen::Index>(m)] = x.dot(model_.stiffness(moduli, x)) / norm;
  }
  quotients_.push_back(std::move(quotient));
  return lowest.bound;
}

}  // namespace rheo
