#include "exponential.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "chebyshev.hpp"

namespace rheo {
namespace {

constexpr std::size_t most_terms = 512;
constexpr double longest_z = 256.0;      // imaginary: longer steps save little more and round worse
constexpr double longest_real = 1500.0;  // real: sqrt(2 z ln(1 / tolerance)) terms have to fit
constexpr double widest = 2.0;           // half width times H across the axis
constexpr double negligible_rate = 0.5;  // rate times H below which the shift is not worth its cost
constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr std::size_t first_look_at_size = 8;
constexpr int most_retries = 16;
constexpr std::size_t most_parts = 16;  // of a state

double norm(const double* x, std::size_t size) {
  // Four sums: independent additions, and smaller rounding.
  double s[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= size; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) s[k] += x[i + k] * x[i + k];
  }
  for (; i < size; ++i) s[0] += x[i] * x[i];
  return std::sqrt((s[0] + s[1]) + (s[2] + s[3]));
}

}  // namespace

Exponential::Exponential(std::size_t size, const IntegratorSettings& settings)
    : settings_(settings),
      coefficients_(most_terms),
      remainders_(most_terms + 1),
      a_(size),
      b_(size),
      sum_(size),
      scale_(most_parts, 0.0),
      peak_(most_parts),
      rest_(most_parts),
      size_(most_parts, 0.0),
      size_before_(most_parts, 0.0),
      sum_size_(most_parts, 0.0),
      sum_scale_(most_parts) {
  assert(settings.frequency >= 0.0 && settings.rate >= 0.0 && settings.tolerance > 0.0);
}

Exponential::Plan Exponential::plan_along(Axis axis, double h, int parts) {
  const double half = 0.5 * settings_.rate;
  const double length = h / parts;
  Plan p;
  p.parts = parts;
  p.axis = axis;
  p.tolerance = std::max(settings_.tolerance / parts, 0.1 * rounding);
  double across = 0.0;
  // A radius above the box only adds terms; z >= 1 keeps the recurrence well scaled.
  if (axis == Axis::imaginary) {
    p.shift = settings_.rate * length > negligible_rate ? half : 0.0;
    p.radius = std::max(settings_.frequency, 1.0 / length);
    across = p.shift > 0.0 ? half : settings_.rate;
  } else {
    p.shift = half;
    p.radius = std::max(half, 1.0 / length);
    across = settings_.frequency;
  }
  const double slope = across / p.radius;
  p.growth = slope + std::sqrt(1.0 + slope * slope);

  const double z = p.radius * length;
  double damping = 1.0;
  if (axis == Axis::imaginary) {
    bessel_j(z, coefficients_);
    damping = std::exp(-p.shift * length);
  } else {
    bessel_i_scaled(z, coefficients_);
    damping = std::exp((p.radius - p.shift) * length);
  }
  for (std::size_t k = 0; k < most_terms; ++k) {
    const bool negative = axis == Axis::real && k / 2 % 2 == 1;
    coefficients_[k] *= damping * (k == 0 ? 1.0 : 2.0) * (negative ? -1.0 : 1.0);
  }
  remainders_[most_terms] = 0.0;
  for (std::size_t k = most_terms; k-- > 0;)
    remainders_[k] = std::abs(coefficients_[k]) + p.growth * remainders_[k + 1];
  // The earliest that could do: terms that have not grown at all.
  std::size_t first = 1;
  while (first + 1 < most_terms && remainders_[first + 1] > p.tolerance) ++first;
  p.first_look = first;
  double grown = std::pow(p.growth, static_cast<double>(first));
  for (p.last_look = first; p.last_look + 1 < most_terms; ++p.last_look, grown *= p.growth) {
    if (grown * remainders_[p.last_look + 1] <= p.tolerance) break;
  }
  return p;
}

void Exponential::make_plan(double h) {
  if (h == planned_for_) return;
  planned_for_ = h;
  const double half = 0.5 * settings_.rate;
  const double frequency = settings_.frequency;
  const auto parts = [](double x, double y) {
    return static_cast<int>(std::min(std::ceil(std::max({1.0, x, y})), 1e9));
  };
  const int imaginary = parts(h * half / (widest * shortening_), h * frequency / (longest_z * shortening_));
  const int real =
      parts(h * frequency / (2.0 * widest * shortening_), h * half / (longest_real * shortening_));
  const auto cost = [](const Plan& p) { return static_cast<double>(p.last_look) * p.parts; };
  const Plan along_real = plan_along(Axis::real, h, real);
  plan_ = plan_along(Axis::imaginary, h, imaginary);
  if (cost(along_real) < cost(plan_)) plan_ = plan_along(Axis::real, h, real);
}

std::vector<double> Exponential::memory() const {
  std::vector<double> memory{settings_.frequency, shortening_};
  memory.insert(memory.end(), scale_.begin(), scale_.end());
  return memory;
}

void Exponential::remember(std::span<const double> memory) {
  assert(memory.size() == 2 + scale_.size());
  settings_.frequency = memory[0];
  shortening_ = memory[1];
  std::copy(memory.begin() + 2, memory.end(), scale_.begin());
  planned_for_ = 0.0;
}

double Exponential::forecast(double h) {
  make_plan(h);
  return static_cast<double>(plan_.first_look) * plan_.parts;
}

void Exponential::advance(LinearOperator& op, double t, double h, std::size_t k, std::span<const double> v,
                          std::span<double> before) {
  const double sign = plan_.axis == Axis::real && k % 2 == 1 ? -1.0 : 1.0;
  const double factor = sign * (k == 0 ? 1.0 : 2.0) / plan_.radius;
  op.fma(factor, v, before, {t, {c_[0], c_[1] * h, c_[2] * h * h, c_[3] * h * h * h}}, before, Result::step);
  if (plan_.shift != 0.0) {
    const double shift = factor * plan_.shift;
    for (std::size_t i = 0; i < v.size(); ++i) before[i] += shift * v[i];
    op.renew(before);
  }
  for (std::size_t j = 4; j-- > 0;) {
    const double slope = (j > 0 ? c_[j - 1] / h : 0.0) + plan_.shift * c_[j];
    c_before_[j] += factor * slope;
  }
  std::swap(c_, c_before_);
}

void Exponential::measure(std::span<const StatePart> parts, std::span<const double> x,
                          std::vector<double>& sizes) {
  std::size_t begin = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    sizes[p] = norm(x.data() + begin, parts[p].size);
    begin += parts[p].size;
  }
}

// largest[p] = max(largest[p], factor sizes[p]); NaN stays.
void Exponential::include(double factor, const std::vector<double>& sizes, std::vector<double>& largest) {
  for (std::size_t p = 0; p < largest.size(); ++p) {
    if (!(factor * sizes[p] <= largest[p])) largest[p] = factor * sizes[p];
  }
}

std::size_t Exponential::first_look(std::span<const StatePart> parts) const {
  double size = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].share > 0.0 && scale_[p] > 0.0)
      size = std::max(size, std::max(size_[p], size_before_[p]) / scale_[p]);
  }
  const double allowed = plan_.tolerance / (size > 0.0 ? std::min(size, 1.0) : 1.0);
  std::size_t first = 1;
  while (first + 1 < plan_.first_look && remainders_[first + 1] > allowed) ++first;
  return first;
}

Exponential::Outcome Exponential::judge(std::span<const StatePart> parts, std::size_t k) {
  const double factor = plan_.growth * remainders_[k + 1];
  std::fill(rest_.begin(), rest_.end(), 0.0);
  include(factor, size_, rest_);
  include(factor, size_before_, rest_);
  const auto small_enough = [&](const std::vector<double>& scale) {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].share > 0.0 && !(rest_[p] <= plan_.tolerance * parts[p].share * scale[p])) return false;
    }
    return true;
  };
  // Terms that outgrow the sum take its digits with them by rounding, whatever is left out. (Not by share: a
  // part that mixes sizes rounds as its largest, with any terms.)
  const auto well_rounded = [&](const std::vector<double>& scale) {
    const double lost_to_rounding = rounding / (0.1 * std::max(settings_.tolerance, 1e-12));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].share > 0.0 && !(lost_to_rounding * peak_[p] <= scale[p])) return false;
    }
    return true;
  };
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!std::isfinite(rest_[p])) return Outcome::lost;
  }
  // The sum itself is looked at only where the sizes so far do not settle it.
  if (small_enough(scale_) && well_rounded(scale_)) return Outcome::done;
  measure(parts, sum_, sum_size_);
  std::copy(scale_.begin(), scale_.end(), sum_scale_.begin());
  include(1.0, sum_size_, sum_scale_);
  if (!small_enough(sum_scale_)) return Outcome::more;
  return well_rounded(sum_scale_) ? Outcome::done : Outcome::lost;
}

bool Exponential::expand(LinearOperator& op, double t, double h, std::span<const double> y,
                         std::span<const double> rate) {
  const std::size_t size = y.size();
  const StatePart whole{size, 1.0};
  const std::span<const StatePart> parts = op.parts().empty() ? std::span(&whole, 1) : op.parts();
  assert(parts.size() <= most_parts);
  measure(parts, y, size_before_);
  include(1.0, size_before_, scale_);
  std::fill(peak_.begin(), peak_.end(), 0.0);
  c_ = {1.0, 0.0, 0.0, 0.0};
  c_before_ = {};
  if (rate.empty()) {
    std::fill(a_.begin(), a_.end(), 0.0);
    advance(op, t, h, 0, y, a_);
  } else {
    const double factor = 1.0 / plan_.radius;
    for (std::size_t i = 0; i < size; ++i) a_[i] = factor * (rate[i] + plan_.shift * y[i]);
    c_ = {factor * plan_.shift, factor / h, 0.0, 0.0};
    c_before_ = {1.0, 0.0, 0.0, 0.0};
  }
  for (std::size_t i = 0; i < size; ++i) sum_[i] = coefficients_[0] * y[i] + coefficients_[1] * a_[i];
  std::copy(y.begin(), y.end(), b_.begin());
  measure(parts, a_, size_);

  const std::size_t first = first_look(parts);
  std::size_t peak_look = first_look_at_size;
  std::size_t measured = 1;  // size_ and size_before_ are those of V_k and V_{k-1} for this k
  std::span<double> v = a_, before = b_;
  for (std::size_t k = 1; k + 2 < most_terms;) {
    const bool looks = k >= first;
    if (looks || k >= peak_look) {
      if (measured + 1 == k) {
        std::swap(size_, size_before_);
        measure(parts, v, size_);
      } else if (measured != k) {
        measure(parts, before, size_before_);
        measure(parts, v, size_);
      }
      measured = k;
    }
    if (k >= peak_look) {
      const double factor = std::max(std::abs(coefficients_[k]), std::abs(coefficients_[k - 1]));
      include(factor, size_, peak_);
      include(factor, size_before_, peak_);
      peak_look += peak_look < 4 * first_look_at_size ? first_look_at_size : 2 * first_look_at_size;
    }
    if (looks) {
      const Outcome outcome = judge(parts, k);
      if (outcome != Outcome::more) return outcome == Outcome::done;
    }
    if (k + 2 <= first) {
      // No look in between: both terms in one pass over the sum.
      advance(op, t, h, k, v, before);
      advance(op, t, h, k + 1, before, v);
      const double even = coefficients_[k + 1];
      const double odd = coefficients_[k + 2];
      for (std::size_t i = 0; i < size; ++i) sum_[i] += even * before[i] + odd * v[i];
      k += 2;
    } else {
      advance(op, t, h, k, v, before);
      std::swap(v, before);
      ++k;
      const double next = coefficients_[k];
      for (std::size_t i = 0; i < size; ++i) sum_[i] += next * v[i];
    }
  }
  return false;
}

void Exponential::step(LinearOperator& op, double t, double h, std::span<double> y,
                       std::span<const double> rate) {
  assert(y.size() == sum_.size());
  converged_ = true;
  double done = 0.0;
  int retries = 0;
  while (done < h) {
    const double begin = done;
    make_plan(h - begin);
    const int parts = plan_.parts;
    const double length = (h - begin) / parts;
    for (int k = 0; k < parts; ++k) {
      const bool fresh = begin == 0.0 && k == 0;
      if (!expand(op, t + done, length, y, fresh ? rate : std::span<const double>())) {
        // The box did not hold the spectrum, or the step was too long for it.
        if (++retries > most_retries) {
          converged_ = false;
          return;
        }
        settings_.frequency = std::max(1.25 * settings_.frequency, 1.0 / length);
        shortening_ = std::max(0.5 * shortening_, 0x1p-10);
        planned_for_ = 0.0;
        break;
      }
      std::copy(sum_.begin(), sum_.end(), y.begin());
      op.renew(y);
      done = k + 1 == parts ? h : begin + (k + 1) * length;
    }
  }
}

}  // namespace rheo
