#include "prony_problem.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <utility>

#include "nnls.hpp"
#include "rheo/relaxation.hpp"

namespace rheo {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of the times [s] that the data can tell of; prony_fit.hpp says why these.
std::array<double, 2> time_range(PronyProblem::Kind kind, const VectorXd& x) {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  bool zero = false;
  for (const double value : x) {
    if (value > 0.0) lowest = std::min(lowest, value);
    zero = zero || value == 0.0;
    highest = std::max(highest, value);
  }
  if (kind == PronyProblem::Kind::sweep) return {std::log(1.0 / (3.0 * highest)), std::log(3.0 / lowest)};
  return {std::log(lowest / (zero ? 4.0 : 2.0)), std::log(3.0 * highest)};
}

// Unknowns p: the times as range.low + width / (1 + exp(-p)), which keeps them within the range, and the
// logarithms of the moduli, which keeps them positive.
struct Refinement : Eigen::DenseFunctor<double> {
  Refinement(const PronyProblem& problem_, PronyShape shape_)
      : Eigen::DenseFunctor<double>(static_cast<int>(shape_.parameters()), static_cast<int>(problem_.rows())),
        problem(problem_),
        shape(std::move(shape_)),
        low(problem_.log_time_range()[0]),
        width(problem_.log_time_range()[1] - low) {}

  Index times() const { return static_cast<Index>(shape.log_times.size()); }

  double share(double p) const { return 1.0 / (1.0 + std::exp(-p)); }

  PronyShape shape_at(const VectorXd& p) const {
    PronyShape at = shape;
    for (Index k = 0; k < times(); ++k) at.log_times[static_cast<std::size_t>(k)] = low + width * share(p[k]);
    return at;
  }

  VectorXd moduli_at(const VectorXd& p) const { return p.tail(shape.moduli()).array().exp(); }

  int operator()(const VectorXd& p, VectorXd& residuals) const {
    residuals = problem.columns(shape_at(p)) * moduli_at(p) - problem.measured();
    return residuals.allFinite() ? 0 : -1;
  }

  int df(const VectorXd& p, MatrixXd& jacobian) const {
    const PronyShape at = shape_at(p);
    const VectorXd moduli = moduli_at(p);
    for (Index k = 0; k < times(); ++k) {
      const double s = share(p[k]);
      jacobian.col(k) = problem.column_slope(at.log_times[static_cast<std::size_t>(k)]) *
                        (moduli[k] * width * s * (1.0 - s));
    }
    jacobian.rightCols(shape.moduli()) = problem.columns(at) * moduli.asDiagonal();
    return 0;
  }

  VectorXd start(const VectorXd& moduli) const {
    VectorXd p(shape.parameters());
    for (Index k = 0; k < times(); ++k) {
      const double s = (shape.log_times[static_cast<std::size_t>(k)] - low) / width;
      const double inside = std::clamp(s, 0.01, 0.99);  // at an end the slope is 0
      p[k] = std::log(inside / (1.0 - inside));
    }
    p.tail(shape.moduli()) = moduli.array().log();
    return p;
  }

  const PronyProblem& problem;
  PronyShape shape;
  double low, width;
};

// Without what has no modulus, the times rising.
PronyGuess tidied(const PronyGuess& guess) {
  const Index terms = static_cast<Index>(guess.shape.log_times.size());
  std::vector<std::pair<double, double>> kept;
  for (Index k = 0; k < terms; ++k) {
    if (guess.moduli[k] > 0.0)
      kept.push_back({guess.shape.log_times[static_cast<std::size_t>(k)], guess.moduli[k]});
  }
  std::sort(kept.begin(), kept.end());
  std::vector<double> moduli;
  PronyGuess tidy{{}, {}, guess.squares};
  for (const auto& [time, modulus] : kept) {
    tidy.shape.log_times.push_back(time);
    moduli.push_back(modulus);
  }
  Index next = terms;
  const auto keep = [&](bool there) {
    if (!there) return false;
    const double modulus = guess.moduli[next++];
    if (modulus > 0.0) moduli.push_back(modulus);
    return modulus > 0.0;
  };
  tidy.shape.elastic = keep(guess.shape.elastic);
  tidy.shape.viscous = keep(guess.shape.viscous);
  tidy.moduli = Eigen::Map<const VectorXd>(moduli.data(), static_cast<Index>(moduli.size()));
  return tidy;
}

}  // namespace

PronyProblem::PronyProblem(Kind kind, VectorXd x, const VectorXd& measured, VectorXd weights)
    : kind_(kind),
      x_(std::move(x)),
      measured_(measured.cwiseProduct(weights)),
      weights_(std::move(weights)),
      range_(time_range(kind, x_)),
      highest_x_(x_.maxCoeff()) {}

VectorXd PronyProblem::column(double log_time) const {
  const double rate = std::exp(-log_time);
  VectorXd values(rows());
  for (Index i = 0; i < x_.size(); ++i) {
    if (kind_ == Kind::relaxation) {
      values[i] = branch_relaxation(1.0, rate, x_[i]);
    } else {
      values[i] = branch_storage(1.0, rate, x_[i]);
      values[x_.size() + i] = branch_loss(1.0, rate, x_[i]);
    }
  }
  return values.cwiseProduct(weights_);
}

// With y = t / time or omega time: y exp(-y); 2 y^2 / (1 + y^2)^2; y (1 - y^2) / (1 + y^2)^2.
VectorXd PronyProblem::column_slope(double log_time) const {
  const double rate = std::exp(-log_time);
  VectorXd values(rows());
  for (Index i = 0; i < x_.size(); ++i) {
    if (kind_ == Kind::relaxation) {
      const double y = x_[i] * rate;
      values[i] = y < 700.0 ? y * std::exp(-y) : 0.0;
    } else {
      const double storage = branch_storage(1.0, rate, x_[i]), loss = branch_loss(1.0, rate, x_[i]);
      values[i] = 2.0 * loss * loss;
      values[x_.size() + i] = loss * (1.0 - 2.0 * storage);
    }
  }
  return values.cwiseProduct(weights_);
}

VectorXd PronyProblem::elastic_column() const {
  VectorXd values = VectorXd::Ones(rows());
  if (kind_ == Kind::sweep) values.tail(x_.size()).setZero();
  return values.cwiseProduct(weights_);
}

VectorXd PronyProblem::viscous_column() const {
  VectorXd values = VectorXd::Zero(rows());
  if (kind_ == Kind::sweep) values.tail(x_.size()) = x_ / highest_x_;
  return values.cwiseProduct(weights_);
}

MatrixXd PronyProblem::columns(const PronyShape& shape) const {
  MatrixXd all(rows(), shape.moduli());
  Index k = 0;
  for (const double log_time : shape.log_times) all.col(k++) = column(log_time);
  if (shape.elastic) all.col(k++) = elastic_column();
  if (shape.viscous) all.col(k++) = viscous_column();
  return all;
}

PronyGuess PronyProblem::solve(PronyShape shape) const {
  const MatrixXd all = columns(shape);
  PronyGuess guess{std::move(shape), nonnegative_least_squares(all, measured_), 0.0};
  guess.squares = (all * guess.moduli - measured_).squaredNorm();
  return tidied(guess);
}

PronyGuess PronyProblem::refine(const PronyGuess& guess, Effort effort) const {
  if (guess.shape.log_times.empty() || guess.shape.parameters() > rows()) return guess;
  Refinement refinement(*this, guess.shape);
  Eigen::LevenbergMarquardt<Refinement> method(refinement);
  // Sums of many exponentials have long flat valleys; a shape is judged well before their ends.
  const bool rough = effort == Effort::rough;
  method.setFtol(rough ? 1e-5 : 1e-12);
  method.setXtol(rough ? 1e-5 : 1e-12);
  method.setMaxfev(rough ? 20 : 200);
  VectorXd p = refinement.start(guess.moduli);
  method.minimize(p);
  if (!p.allFinite()) return guess;
  PronyGuess refined = solve(refinement.shape_at(p));
  return refined.squares < guess.squares ? refined : guess;
}

}  // namespace rheo
