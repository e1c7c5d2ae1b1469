#include "view/history.hpp"

#include <cmath>

namespace app::view {
namespace {

constexpr std::size_t most_samples = 3000;

}  // namespace

double drift_of(const Display& display) {
  const rheo::Energies& e = display.energies;
  return e.kinetic + e.stored + e.dissipated - e.work - display.energy_start;
}

void History::clear() {
  for (std::vector<double>* x :
       {&t, &w_lambda, &w_mu, &kinetic, &stored, &dissipated, &work, &drift, &moved, &force})
    x->clear();
  least_ = 0.0;
}

void History::thin_out() {
  for (std::vector<double>* x :
       {&t, &w_lambda, &w_mu, &kinetic, &stored, &dissipated, &work, &drift, &moved, &force}) {
    for (std::size_t i = 0; 2 * i < x->size(); ++i) (*x)[i] = (*x)[2 * i];
    x->resize((x->size() + 1) / 2);
  }
  least_ = (t.back() - t.front()) / static_cast<double>(most_samples - 1);
}

void History::add(const Display& display) {
  if (display.body != body_ || (!t.empty() && display.t < t.back())) clear();
  body_ = display.body;
  if (!t.empty() && display.t < t.back() + least_) return;
  if (!t.empty() && display.t == t.back()) return;
  t.push_back(display.t);
  w_lambda.push_back(display.w_lambda_norm);
  w_mu.push_back(display.w_mu_norm);
  kinetic.push_back(display.energies.kinetic);
  stored.push_back(display.energies.stored);
  dissipated.push_back(display.energies.dissipated);
  work.push_back(display.energies.work);
  drift.push_back(drift_of(display));
  moved.push_back(std::hypot(display.hand.displacement.x, display.hand.displacement.y));
  force.push_back(std::hypot(display.hand.force.x, display.hand.force.y));
  if (t.size() > most_samples) thin_out();
}

}  // namespace app::view
