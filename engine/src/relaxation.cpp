#include "rheo/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace rheo {

double branch_relaxation(double ela, double rate, double t) {
  return ela * std::exp(-rate * t);
}

// With x = rate / omega = 1 / (omega tau) or its inverse, whichever is at most 1: no square overflows.
double branch_storage(double ela, double rate, double omega) {
  if (rate == 0.0) return ela;
  if (rate <= omega) {
    const double x = rate / omega;
    return ela / (1.0 + x * x);
  }
  const double x = omega / rate;
  return ela * (x * x / (1.0 + x * x));
}

double branch_loss(double ela, double rate, double omega) {
  const double larger = std::max(rate, omega);
  if (larger == 0.0) return 0.0;
  const double x = std::min(rate, omega) / larger;
  return ela * (x / (1.0 + x * x));
}

Moduli relaxation(const Material& material, double t) {
  Moduli r = material.elastic;
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch b = material.branch(k);
    r.lambda += branch_relaxation(b.lambda_ela, b.lambda_rate(), t);
    r.mu += branch_relaxation(b.mu_ela, b.mu_rate(), t);
  }
  return r;
}

ComplexModuli complex_moduli(const Material& material, double omega) {
  ComplexModuli moduli{material.elastic, {omega * material.viscous.lambda, omega * material.viscous.mu}};
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch b = material.branch(k);
    moduli.storage.lambda += branch_storage(b.lambda_ela, b.lambda_rate(), omega);
    moduli.storage.mu += branch_storage(b.mu_ela, b.mu_rate(), omega);
    moduli.loss.lambda += branch_loss(b.lambda_ela, b.lambda_rate(), omega);
    moduli.loss.mu += branch_loss(b.mu_ela, b.mu_rate(), omega);
  }
  return moduli;
}

std::optional<Span> relaxation_times(const Material& material) {
  std::optional<Span> span;
  const auto add = [&](double rate) {
    if (rate <= 0.0) return;
    const double time = 1.0 / rate;
    if (!span) span = Span{time, time};
    span->shortest = std::min(span->shortest, time);
    span->longest = std::max(span->longest, time);
  };
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    add(material.branch(k).lambda_rate());
    add(material.branch(k).mu_rate());
  }
  return span;
}

}  // namespace rheo
