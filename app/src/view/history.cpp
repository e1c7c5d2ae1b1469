#include "view/history.hpp"

#include <algorithm>

namespace app::view {

History::History() {
  for (std::vector<double>* column : columns()) column->reserve(most_samples);
}

std::array<std::vector<double>*, 10> History::columns() {
  return {&t, &w_lambda, &w_mu, &kinetic, &stored, &dissipated, &work, &drift, &moved, &force};
}
std::array<const std::vector<double>*, 10> History::columns() const {
  return {&t, &w_lambda, &w_mu, &kinetic, &stored, &dissipated, &work, &drift, &moved, &force};
}

void History::begin(std::int64_t first_every) {
  for (std::vector<double>* column : columns()) column->clear();
  every_ = std::max<std::int64_t>(first_every, 1);
  ++beginning_;
}

void History::add(const Sample& s) {
  const std::array<double, 10> values{s.t,          s.w_lambda, s.w_mu,  s.kinetic, s.stored,
                                      s.dissipated, s.work,     s.drift, s.moved,   s.force};
  const auto all = columns();
  for (std::size_t k = 0; k < all.size(); ++k) all[k]->push_back(values[k]);
  if (t.size() < most_samples) return;
  for (std::vector<double>* column : all) {
    for (std::size_t i = 0; 2 * i < column->size(); ++i) (*column)[i] = (*column)[2 * i];
    column->resize((column->size() + 1) / 2);
  }
  every_ *= 2;
  ++beginning_;
}

void History::follow(const History& newer) {
  const auto mine = columns();
  const auto theirs = newer.columns();
  const std::size_t known = beginning_ == newer.beginning_ ? size() : 0;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    mine[k]->resize(known);
    mine[k]->insert(mine[k]->end(), theirs[k]->begin() + static_cast<std::ptrdiff_t>(known),
                    theirs[k]->end());
  }
  every_ = newer.every_;
  beginning_ = newer.beginning_;
}

}  // namespace app::view
