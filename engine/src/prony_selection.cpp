#include "prony_selection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "rheo/error.hpp"

namespace rheo {
namespace {

using Eigen::Index;

constexpr double grid_per_decade = 10.0;   // times of the first, linear fit
constexpr double most_grid_times = 250.0;  // over any span

// The linear fit over a grid of times, neighbours on the grid as one term at their centre.
PronyShape first_shape(const PronyProblem& problem) {
  const auto [low, high] = problem.log_time_range();
  const double decades = (high - low) / std::numbers::ln10;
  const int steps =
      std::max(2, static_cast<int>(std::ceil(std::min(grid_per_decade * decades, most_grid_times))));
  const double step = (high - low) / steps;
  PronyShape grid{{}, true, problem.kind() == PronyProblem::Kind::sweep};
  for (int k = 0; k <= steps; ++k) grid.log_times.push_back(low + step * k);
  const PronyGuess guess = problem.solve(std::move(grid));

  PronyShape merged{{}, guess.shape.elastic, guess.shape.viscous};
  const std::vector<double>& times = guess.shape.log_times;
  for (std::size_t first = 0; first < times.size();) {
    std::size_t end = first;
    double modulus = 0.0, moment = 0.0;
    for (; end < times.size() && (end == first || times[end] - times[end - 1] < 1.5 * step); ++end) {
      modulus += guess.moduli[static_cast<Index>(end)];
      moment += guess.moduli[static_cast<Index>(end)] * times[end];
    }
    merged.log_times.push_back(moment / modulus);
    first = end;
  }
  return merged;
}

// All shapes with one term or part less.
std::vector<PronyShape> smaller_shapes(const PronyGuess& guess, PronyProblem::Kind kind) {
  std::vector<PronyShape> shapes;
  const std::vector<double>& times = guess.shape.log_times;
  const auto without = [&](std::size_t k) {
    PronyShape shape = guess.shape;
    shape.log_times.erase(shape.log_times.begin() + static_cast<std::ptrdiff_t>(k));
    return shape;
  };
  for (std::size_t k = 0; k < times.size(); ++k) shapes.push_back(without(k));
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double a = guess.moduli[static_cast<Index>(k)], b = guess.moduli[static_cast<Index>(k) + 1];
    shapes.push_back(without(k));
    shapes.back().log_times[k] = (a * times[k] + b * times[k + 1]) / (a + b);
  }
  // The slowest term may become elastic, the fastest of a sweep viscous.
  if (guess.shape.elastic || !times.empty()) {
    shapes.push_back(guess.shape.elastic ? guess.shape : without(times.size() - 1));
    shapes.back().elastic = !guess.shape.elastic;
  }
  if (kind == PronyProblem::Kind::sweep && (guess.shape.viscous || !times.empty())) {
    shapes.push_back(guess.shape.viscous ? guess.shape : without(0));
    shapes.back().viscous = !guess.shape.viscous;
  }
  std::erase_if(shapes, [](const PronyShape& shape) { return shape.moduli() == 0; });
  return shapes;
}

class Selection {
 public:
  Selection(const PronyProblem& problem, double count, double scatter, const PronyOptions& options)
      : problem_(problem),
        count_(count),
        scatter_(scatter),
        most_terms_(static_cast<std::size_t>(options.terms > 0 ? options.terms : most_prony_terms)) {}

  PronyGuess best() const {
    std::optional<PronyGuess> best;
    PronyGuess guess = refined(first_shape(problem_));
    if (guess.shape.moduli() == 0)
      throw Error(Error::Kind::input, "no sum of relaxing moduli >= 0 comes near the data");
    while (true) {
      const bool allowed = guess.shape.log_times.size() <= most_terms_ &&
                           (guess.shape.parameters() <= problem_.rows() || guess.shape.moduli() == 1);
      if (allowed && (!best || criterion(guess) < criterion(*best))) best = guess;
      const std::optional<PronyGuess> next = smaller(guess);
      if (!next) break;
      guess = *next;
    }
    return problem_.refine(*best, PronyProblem::Effort::full);
  }

 private:
  // The best guess with one term or part less; empty where nothing can go. With linear fits alone the choice
  // is short-sighted, so that of few terms several are refined.
  std::optional<PronyGuess> smaller(const PronyGuess& guess) const {
    constexpr std::size_t few_terms = 8, tried = 4;
    std::vector<PronyGuess> guesses;
    for (PronyShape& shape : smaller_shapes(guess, problem_.kind())) {
      guesses.push_back(problem_.solve(std::move(shape)));
      if (guesses.back().shape.moduli() == 0) guesses.pop_back();
    }
    const auto better = [&](const PronyGuess& a, const PronyGuess& b) { return criterion(a) < criterion(b); };
    std::stable_sort(guesses.begin(), guesses.end(), better);
    const std::size_t most = guess.shape.log_times.size() <= few_terms ? tried : 1;
    if (guesses.size() > most) guesses.resize(most);
    for (PronyGuess& each : guesses) each = problem_.refine(each, PronyProblem::Effort::rough);
    const auto best = std::min_element(guesses.begin(), guesses.end(), better);
    if (best == guesses.end()) return std::nullopt;
    return *best;
  }

  PronyGuess refined(PronyShape shape) const {
    return problem_.refine(problem_.solve(std::move(shape)), PronyProblem::Effort::rough);
  }

  double criterion(const PronyGuess& guess) const {
    const double error = std::max(std::sqrt((guess.squares + scatter_) / count_), finest_fit);
    return 2.0 * count_ * std::log(error) + static_cast<double>(guess.shape.parameters()) * std::log(count_);
  }

  const PronyProblem& problem_;
  double count_;    // of the measured values
  double scatter_;  // squares within the rows that no fit can lessen
  std::size_t most_terms_;
};

}  // namespace

PronyGuess select_terms(const PronyProblem& problem, double count, double scatter,
                        const PronyOptions& options) {
  return Selection(problem, count, scatter, options).best();
}

}  // namespace rheo
