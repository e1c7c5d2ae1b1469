#include "range_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <utility>
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
constexpr double strip = 1.06;           // from one step to the next
constexpr int deepest_open = 5;          // halvings of a cell that nothing excludes as a whole
constexpr int deepest_met = 7;           // of one that witnesses may be in
constexpr double slowest = 10.0;         // of the places: 2,400 times slower than anything can be fast
constexpr double slowest_of_all = 45.0;  // of those for discs
constexpr double beyond = 0.6;           // of the way to the witnesses: where looking excludes most
// Of discs: halvings of a cell that none contains as a whole; how far the next one's centre is ahead, of the
// last one's radius, and at most of its frequency.
constexpr int deepest_unknown = 10;
constexpr double ahead = 0.65, most_ahead = 0.3, aside = 0.4;
constexpr int attempts = 4;
// Digits of a damping: how near to one another its bounds are, and a centre from which there are no more.
constexpr double legible = 0.98, close = 0.01;
constexpr double promised = 0.95;     // of the limit: what RangeStep promises
constexpr double least_share = 1e-9;  // of the cap: steps that are looked for where none is known

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
    for (const double pole : {rate, spectrum.baumgarte})
      if (pole > 0.0) cap_ = std::min(cap_, 0.999 * stable_step_of(-pole, integrator));
    if (integrator == IntegratorKind::rk4) {
      for (int i = 0; i <= 90; ++i) places_.push_back(i / 90.0);
    } else {
      for (int i = 0; i <= 20 * slowest; ++i) places_.push_back(0.05 * i);
      whole_cap_ = cap_;
      hold_slow_ones();
    }
    if (surely > 0.0) add_strips(surely);
    contact_ = cap_;
  }

  // By the range alone; 0 where nothing is gained.
  double find() {
    if (strips_.empty()) return 0.0;
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

  // `known` is stable; 0 where nothing as large, or larger, is known to be near.
  double find_by_discs(const DiscSearch& search, double known) {
    NearbyEigenvalues eigenvalues = search.eigenvalues();
    leave_creep_out(eigenvalues);
    if (strips_.empty()) add_strips(0.0);
    // Between which the limit is; of all that is in the discs.
    double low = cap_, high = whole_cap_;
    std::vector<char> is_done(places_.size(), 0);
    std::complex<double> last = 0.0;
    double radius = 0.0;
    int attempt = 0;
    while (known < near_enough * low && eigenvalues.work() < search.most_work) {
      if (search.told && !discs_.empty()) search.told(eigenvalues.work() / search.most_work);
      const std::complex<double> open = first_unknown(asked_share * low, is_done);
      if (open == 0.0) {
        known = std::max(known, bent * asked_share * low);
        break;
      }
      const std::complex<double> wanted = 1.0 / std::conj(open);
      attempt = open == last ? attempt + 1 : 0;
      if (attempt == attempts) break;
      last = open;
      const std::complex<double> centre = centre_for(wanted, asked_share * low, attempt, radius);
      Disc disc = eigenvalues.around(centre, wanted);
      radius = disc.radius;
      for (const auto& [s, error] : disc.eigenvalues) {
        if (!disc.contains(s)) continue;
        const double more = stable_step_of({std::min(s.real() - error, 0.0), s.imag()}, integrator_);
        const double less = stable_step_of({std::min(s.real() + error, 0.0), s.imag()}, integrator_);
        const double least = std::min(less, more), most = std::max(less, more);
        const double distance = std::abs(s - centre);
        if (least < low && least < legible * most && distance > close * std::abs(s)) {
          disc.radius = 0.99 * distance;  // left to a disc that sees more of its digits
          continue;
        }
        low = std::min(low, least);
        high = std::min(high, most);
      }
      discs_.push_back(std::move(disc));
    }
    return high > 0.0 && known >= promised * high ? known : 0.0;
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

  void add_strips(double from) {
    if (from == 0.0) {
      strips_.push_back({0.0, std::vector<char>(places_.size(), 1)});
      from = 1.0 / largest_;
    }
    const double ratio = std::max(strip, std::pow(cap_ / from, 1.0 / most_strips));
    for (double h = from; h < cap_; h *= ratio) strips_.push_back({h, std::vector<char>(places_.size(), 1)});
  }

  // What is slower than all places is excluded by its signs, or not at all.
  void hold_slow_ones() {
    double low = surely_ > 0.0 ? 0.9 * surely_ : least_share * cap_, high = cap_;
    if (surely_ == 0.0 && !range_.excludes_slower(at(slowest, low))) {
      cap_ = 0.0;
      return;
    }
    while (high - low > 0.01 * low) {
      const double middle = std::sqrt(low * high);
      (range_.excludes_slower(at(slowest, middle)) ? low : high) = middle;
    }
    cap_ = low;
  }

  // Of a disc that contains s: further on along the vibrations; or s, if that did not do; or off the creeping
  // motions, or the many within the region of stability for h, where what is near is more than can be found.
  static std::complex<double> centre_for(std::complex<double> s, double h, int attempt, double last_radius) {
    const double size = std::abs(s);
    switch (attempt) {
      case 0:
        return {s.real(), s.imag() - std::min(ahead * last_radius, most_ahead * s.imag())};
      case 1:
        return s;
      case 2:
        return {s.real(), s.imag() + aside * size};
      default:
        return s + aside * size * (s + 1.0 / h) / std::abs(s + 1.0 / h);
    }
  }

  // Slow motions only creep; how slow that is takes the place of their signs.
  void leave_creep_out(const NearbyEigenvalues& eigenvalues) {
    for (double p = 1.0; p <= slowest_of_all; p += 0.5) {
      const double frequency = 1.0 / at(p, 0.0).imag();
      if (!eigenvalues.nothing_vibrates_below(frequency)) continue;
      vibrates_from_ = frequency;
      while (places_.back() < p) places_.push_back(0.05 * static_cast<double>(places_.size()));
      for (Strip& each : strips_) each.is_open.resize(places_.size(), 1);
      const double held = std::exchange(cap_, whole_cap_);
      if (held < cap_ && !strips_.empty()) add_strips(held);
      return;
    }
  }

  std::array<std::complex<double>, 4> corners(const Cell& c) const {
    return {at(c.p, c.h), at(c.next_p, c.h), at(c.p, c.next_h), at(c.next_p, c.next_h)};
  }

  // No eigenvalue is that large.
  bool too_fast(const std::array<std::complex<double>, 4>& z) const {
    return std::ranges::all_of(z, [&](std::complex<double> each) { return std::abs(each) * largest_ < 1.0; });
  }

  bool only_creeps(const std::array<std::complex<double>, 4>& z) const {
    return z[0].imag() * vibrates_from_ >= 1.0;
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

  // As first_open, but by discs too, from the fastest vibrations on; places that are done stay so for shorter
  // steps.
  std::complex<double> first_unknown(double h, std::vector<char>& is_done) const {
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      if (is_done[i] != 0) continue;
      for (std::size_t k = 0; k < strips_.size() && strips_[k].h < h; ++k) {
        if (strips_[k].is_open[i] == 0) continue;
        const double next_h = k + 1 < strips_.size() ? std::min(strips_[k + 1].h, h) : h;
        Cell cell{places_[i], places_[i + 1], strips_[k].h, next_h};
        if (find_unknown(cell, 0)) return at(0.5 * (cell.p + cell.next_p), 0.5 * (cell.h + cell.next_h));
      }
      is_done[i] = 1;
    }
    return 0.0;
  }

  bool find_unknown(Cell& cell, int depth) const {
    const auto z = corners(cell);
    if (too_fast(z) || only_creeps(z) || is_in_disc(z) || range_.excludes(z)) return false;
    if (depth == deepest_unknown) return true;
    // Damping is far less than frequency: cells are halved along the longer side.
    Cell first = cell, second = cell;
    if (std::abs(z[1] - z[0]) >= std::abs(z[2] - z[0]))
      first.next_p = second.p = 0.5 * (cell.p + cell.next_p);
    else
      first.next_h = second.h = 0.5 * (cell.h + cell.next_h);
    for (Cell part : {first, second}) {
      if (!find_unknown(part, depth + 1)) continue;
      cell = part;
      return true;
    }
    return false;
  }

  // What lies between them too: no disc contains s = 0, hence discs of z are they as well.
  bool is_in_disc(const std::array<std::complex<double>, 4>& z) const {
    return std::ranges::any_of(discs_, [&](const Disc& disc) {
      return std::ranges::all_of(
          z, [&](std::complex<double> each) { return disc.contains(1.0 / std::conj(each)); });
    });
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
  double surely_, largest_ = 0.0, cap_ = 0.0, whole_cap_ = 0.0, contact_ = 0.0;
  double vibrates_from_ = 0.0;  // no frequency is below
  std::vector<double> places_;
  std::vector<Strip> strips_;
  std::vector<Disc> discs_;
};

}  // namespace

RangeStep range_step(const Model& model, const ConstraintSolver& solver, const Spectrum& spectrum,
                     IntegratorKind integrator, double surely, const DiscSearch* discs) {
  RangeSearch search(model, solver, spectrum, integrator, surely);
  RangeStep result{search.find(), 0.0};
  if (discs != nullptr) {
    try {
      result.near_step = search.find_by_discs(*discs, std::max(surely, result.step));
    } catch (const std::bad_alloc&) {
      // What is known without will do.
    }
  }
  return result;
}

}  // namespace rheo
