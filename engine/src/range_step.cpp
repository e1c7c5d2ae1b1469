#include "range_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace rheo {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Of the limit by the witnesses, what is asked for; and what bent edges of the smallest cells may hide.
constexpr double asked_share = 0.985, bent = 0.997;
constexpr double near_enough = 0.97;  // of it: no more is looked for
constexpr int most_looks = 100;
constexpr double most_work = 1e9;  // products times their size: about half a minute on a million triangles
constexpr std::int64_t most_trials = 4000000;  // about a second
constexpr int most_strips = 120;
constexpr double strip = 1.06;    // from one step to the next
constexpr int deepest_open = 5;   // halvings of a cell that nothing excludes as a whole
constexpr int deepest_met = 7;    // of one that witnesses may be in
constexpr double slowest = 10.0;  // of the places: 2,400 times slower than anything can be fast
constexpr double beyond = 0.6;    // of the way to the witnesses: where looking excludes most

class RangeSearch {
 public:
  RangeSearch(const Model& model, const ConstraintSolver& solver, const Spectrum& spectrum,
              IntegratorKind integrator, double surely)
      : range_(model, solver),
        size_(static_cast<double>(model.layout.part)),
        integrator_(integrator),
        surely_(surely) {
    double rate =
        std::max(spectrum.lambda_on ? spectrum.lambda_rate : 0.0, spectrum.mu_on ? spectrum.mu_rate : 0.0);
    for (const Relaxation& each : spectrum.relaxations) rate = std::max(rate, each.rate);
    largest_ = spectrum.omega_max + spectrum.largest_rate();
    cap_ = 100.0 / std::max(spectrum.omega_max, spectrum.viscous_max);
    if (rate > 0.0) cap_ = std::min(cap_, 0.999 * stable_step_of(-rate, integrator));
    if (integrator == IntegratorKind::rk4) {
      for (int i = 0; i <= 90; ++i) places_.push_back(i / 90.0);
    } else {
      for (int i = 0; i <= 20 * slowest; ++i) places_.push_back(0.05 * i);
      hold_slow_ones();
    }
    const double ratio = std::max(strip, std::pow(cap_ / surely, 1.0 / most_strips));
    for (double h = surely; h < cap_; h *= ratio)
      strips_.push_back({h, std::vector<char>(places_.size(), 1)});
    contact_ = cap_;
  }

  double find() {
    double share = asked_share;
    std::complex<double> last = 0.0;
    int times = 0;
    for (int looks = 0; looks < most_looks && !has_worked_enough(); ++looks) {
      meet();
      // Of what is stable for sure nothing is to be gained then.
      if (surely_ >= near_enough * contact_) return 0.0;
      const double step = share * (contact_ < cap_ ? contact_ : cap_ / asked_share);
      if (step <= surely_) return 0.0;
      const std::complex<double> open = first_open(step);
      if (open == 0.0) return bent * step;
      // Once by either direction, then less is asked for.
      times = open == last ? times + 1 : 0;
      last = open;
      if (times > 1) {
        share *= 0.98;
        continue;
      }
      range_.look_at(open, times == 0 ? NumericalRange::Clearest::part : NumericalRange::Clearest::distance);
    }
    // What is excluded so far.
    double low = surely_, high = contact_;
    while (high - low > 0.01 * low) {
      const double middle = std::sqrt(low * high);
      (first_open(middle) == 0.0 ? low : high) = middle;
    }
    return low > surely_ ? bent * low : 0.0;
  }

 private:
  // Steps from h on, up to the next strip; and which of its cells are not known to be excluded.
  struct Strip {
    double h = 0.0;
    std::vector<char> is_open;
  };
  struct Cell {
    double p = 0.0, next_p = 0.0, h = 0.0, next_h = 0.0;
  };

  // z = 1 / s at which a step h is at the limit. Places from 0 to 1 (RK4: from the imaginary axis to the real
  // one) or from 0 on (Euler: Im z, from the real axis on, beyond 1 by its logarithm).
  std::complex<double> at(double p, double h) const {
    if (integrator_ == IntegratorKind::rk4) {
      const double angle = std::numbers::pi / 2 * p;
      const std::complex<double> direction(-std::sin(angle), p < 1.0 ? std::cos(angle) : 0.0);
      return h * direction / stable_step_of(direction, integrator_);
    }
    const double from = 0.3 / largest_;
    return {-0.5 * h, p < 1.0 ? from * p : from * std::exp(p - 1.0)};
  }

  // What is slower than all places is excluded by its signs, or not at all.
  void hold_slow_ones() {
    double low = 0.9 * surely_, high = cap_;
    while (high - low > 0.01 * low) {
      const double middle = std::sqrt(low * high);
      (range_.excludes_slower(at(slowest, middle)) ? low : high) = middle;
    }
    cap_ = low;
  }

  std::array<std::complex<double>, 4> corners(const Cell& c) const {
    return {at(c.p, c.h), at(c.next_p, c.h), at(c.p, c.next_h), at(c.next_p, c.next_h)};
  }

  // No eigenvalue is that large.
  bool too_fast(const std::array<std::complex<double>, 4>& z) const {
    return std::ranges::all_of(z, [&](std::complex<double> each) { return std::abs(each) * largest_ < 1.0; });
  }

  static std::array<Cell, 4> quarters(const Cell& c) {
    const double p = 0.5 * (c.p + c.next_p), h = 0.5 * (c.h + c.next_h);
    return {Cell{c.p, p, c.h, h}, {p, c.next_p, c.h, h}, {c.p, p, h, c.next_h}, {p, c.next_p, h, c.next_h}};
  }

  bool has_worked_enough() const {
    return range_.products() * size_ > most_work || range_.trials() > most_trials;
  }

  // contact_: the shortest step at which witnesses are at the limit.
  void meet() {
    for (std::size_t k = 0; k < strips_.size() && strips_[k].h < contact_; ++k) {
      const double next = std::min(k + 1 < strips_.size() ? strips_[k + 1].h : cap_, contact_);
      for (std::size_t i = 0; i + 1 < places_.size(); ++i)
        contact_ = std::min(contact_, meets({places_[i], places_[i + 1], strips_[k].h, next}, 0));
    }
  }

  double meets(const Cell& cell, int depth) const {
    if (cell.h >= contact_) return infinite;
    const auto z = corners(cell);
    if (too_fast(z) || !range_.includes(z)) return infinite;
    if (depth == deepest_met) return cell.h;
    double first = infinite;
    for (const Cell& part : quarters(cell)) {
      if (part.h < first) first = std::min(first, meets(part, depth + 1));
    }
    return first;
  }

  // z = 1 / s to look at: of a cell, or beyond one, that is not excluded up to h; 0 where all are.
  std::complex<double> first_open(double h) {
    for (std::size_t k = 0; k < strips_.size() && strips_[k].h < h; ++k) {
      const bool is_last = k + 1 == strips_.size() || strips_[k + 1].h >= h;
      for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
        if (strips_[k].is_open[i] == 0) continue;
        Cell cell{places_[i], places_[i + 1], strips_[k].h, is_last ? h : strips_[k + 1].h};
        if (find_open(cell, 0)) return look_beyond(cell, h);
        if (!is_last) strips_[k].is_open[i] = 0;
      }
    }
    return 0.0;
  }

  // Makes `cell` the part that is not excluded; false where all of it is.
  bool find_open(Cell& cell, int depth) const {
    const auto z = corners(cell);
    if (too_fast(z) || range_.excludes(z)) return false;
    if (depth == deepest_open) return true;
    for (Cell part : quarters(cell)) {
      if (!find_open(part, depth + 1)) continue;
      cell = part;
      return true;
    }
    return false;
  }

  std::complex<double> look_beyond(const Cell& cell, double h) const {
    const double p = 0.5 * (cell.p + cell.next_p);
    const std::complex<double> here = at(p, 0.5 * (cell.h + cell.next_h));
    if (cell.next_h < h) return here;
    double last = h;
    for (double next = 1.02 * h; next < 1.5 * h; next *= 1.02) {
      const std::complex<double> z[] = {at(p, last), at(p, next)};
      if (range_.includes(z)) break;
      last = next;
    }
    const std::complex<double> there = at(p, h + beyond * (last - h));
    return range_.excludes({&there, 1}) ? here : there;
  }

  NumericalRange range_;
  double size_;  // of its vectors
  IntegratorKind integrator_;
  double surely_, largest_ = 0.0, cap_ = 0.0, contact_ = 0.0;
  std::vector<double> places_;
  std::vector<Strip> strips_;
};

}  // namespace

double range_step(const Model& model, const ConstraintSolver& solver, const Spectrum& spectrum,
                  IntegratorKind integrator, double surely) {
  if (!(surely > 0.0)) return 0.0;
  return RangeSearch(model, solver, spectrum, integrator, surely).find();
}

}  // namespace rheo
