#include "rest_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rheo/io/bytes.hpp"

namespace rheo {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double swings = 10.0;  // of u_top / v_top: a swing and a half

double largest(std::span<const double> x) {
  double found = 0.0;
  for (const double value : x) found = std::max(found, std::abs(value));
  return found;
}

// Of one modulus, of all materials together.
struct Springs {
  double elastic = infinite;  // the softest elastic part; infinite: none has one
  double stiffest = 0.0;      // all springs of one material
  double slowest_rate = infinite;
  double viscous = 0.0;

  double slowest_time() const {
    const bool holds = std::isfinite(elastic);
    double slowest = holds ? viscous / elastic : 0.0;
    if (std::isfinite(slowest_rate))
      slowest = std::max(slowest, (holds ? 1.0 + stiffest / elastic : 1.0) / slowest_rate);
    return slowest;
  }
};

Springs springs_of(std::span<const Material> materials, double Moduli::*modulus,
                   double (MaxwellBranch::*rate_of)() const, double MaxwellBranch::*ela) {
  Springs all;
  for (const Material& material : materials) {
    double elastic = material.elastic.*modulus, springs = 0.0;
    for (std::size_t k = 0; k < material.branch_count(); ++k) {
      const MaxwellBranch branch = material.branch(k);
      const double rate = (branch.*rate_of)();
      springs += branch.*ela;
      if (rate == 0.0)
        elastic += branch.*ela;
      else
        all.slowest_rate = std::min(all.slowest_rate, rate);
    }
    if (elastic > 0.0) all.elastic = std::min(all.elastic, elastic);
    all.stiffest = std::max(all.stiffest, springs);
    all.viscous = std::max(all.viscous, material.viscous.*modulus);
  }
  return all;
}

}  // namespace

RestWatch::RestWatch(std::span<const Material> materials, std::size_t size, double share)
    : share_(share),
      slowest_(std::max(
          springs_of(materials, &Moduli::lambda, &MaxwellBranch::lambda_rate, &MaxwellBranch::lambda_ela)
              .slowest_time(),
          springs_of(materials, &Moduli::mu, &MaxwellBranch::mu_rate, &MaxwellBranch::mu_ela)
              .slowest_time())),
      mark_(slowest_ > 0.0 ? size : 0) {}

void RestWatch::put(ByteWriter& out) const {
  out.put(u_top_);
  out.put(v_top_);
  out.put(static_cast<std::uint64_t>(marked_ ? 1 : 0));
  if (!marked_) return;
  out.put(mark_time_);
  out.put_list(mark_);
}

void RestWatch::get(ByteReader& in) {
  u_top_ = in.get<double>();
  v_top_ = in.get<double>();
  marked_ = in.get<std::uint64_t>() != 0;
  if (!marked_) return;
  mark_time_ = in.get<double>();
  in.get_list(std::span(mark_));
}

bool RestWatch::look(double t, std::span<const double> u, std::span<const double> v, double omega) {
  if (slowest_ == 0.0) return false;
  const double reach = largest(u);
  u_top_ = std::max(u_top_, reach);
  v_top_ = std::max(v_top_, largest(v));
  double moved = 0.0;
  for (std::size_t i = 0; marked_ && i < u.size(); ++i) moved = std::max(moved, std::abs(u[i] - mark_[i]));
  if (!marked_ || !(moved <= share_ * reach)) {
    std::copy(u.begin(), u.end(), mark_.begin());
    mark_time_ = t;
    marked_ = true;
    return false;
  }
  double time = slowest_;
  if (v_top_ > 0.0) time = std::max(time, swings * u_top_ / v_top_);
  if (omega > 0.0) time = std::max(time, 1.0 / omega);
  return t - mark_time_ >= time;
}

}  // namespace rheo
