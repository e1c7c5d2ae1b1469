// What the live plots show: samples at even simulated times, taken by the physics, whoever looks and however
// often. When they have grown many, every second one goes and the times between them double.
//
//   sample i is of tick i every
//
// Units    SI
// Memory   taken at construction
// Errors   none
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace app::view {

class History {
 public:
  static constexpr std::size_t most_samples = 3000;

  History();
  // first_every: ticks between samples, at first.
  void begin(std::int64_t first_every);
  bool is_due(std::int64_t tick) const { return tick == static_cast<std::int64_t>(t.size()) * every_; }
  struct Sample {
    double t, w_lambda, w_mu, kinetic, stored, dissipated, work, drift, moved, force;
  };
  void add(const Sample& sample);
  // Becomes like `newer`, of which it may have seen the beginning.
  void follow(const History& newer);

  std::size_t size() const { return t.size(); }
  std::vector<double> t, w_lambda, w_mu, kinetic, stored, dissipated, work, drift, moved, force;

 private:
  std::array<std::vector<double>*, 10> columns();
  std::array<const std::vector<double>*, 10> columns() const;

  std::int64_t every_ = 1;
  std::int64_t beginning_ = 0;  // another number: what was before has changed
};

}  // namespace app::view
