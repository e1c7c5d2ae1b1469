#include "rest_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rheo {
namespace {

constexpr double swings = 10.0;  // of u_top / v_top: a swing and a half

double largest(std::span<const double> x) {
  double found = 0.0;
  for (const double value : x) found = std::max(found, std::abs(value));
  return found;
}

double slowest_time(double elastic, double viscous, const Material& material,
                    double (MaxwellBranch::*rate_of)() const, double MaxwellBranch::*ela) {
  double springs = 0.0;
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch branch = material.branch(k);
    springs += branch.*ela;
    if ((branch.*rate_of)() == 0.0) elastic += branch.*ela;
  }
  double slowest = elastic > 0.0 ? viscous / elastic : 0.0;
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const double rate = (material.branch(k).*rate_of)();
    if (rate > 0.0) slowest = std::max(slowest, (elastic > 0.0 ? 1.0 + springs / elastic : 1.0) / rate);
  }
  return slowest;
}

}  // namespace

RestWatch::RestWatch(const Material& material, std::size_t size, double share)
    : share_(share),
      slowest_(std::max(slowest_time(material.elastic.lambda, material.viscous.lambda, material,
                                     &MaxwellBranch::lambda_rate, &MaxwellBranch::lambda_ela),
                        slowest_time(material.elastic.mu, material.viscous.mu, material,
                                     &MaxwellBranch::mu_rate, &MaxwellBranch::mu_ela))),
      mark_(slowest_ > 0.0 ? size : 0) {}

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
