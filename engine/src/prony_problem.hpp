// The least squares problem behind a Prony series' fit: rows of scaled measurements, columns of terms.
//
//   |sum_k modulus_k column(time_k) + elastic column_e + viscous column_v - measured|^2 -> least
//
// Shapes   a relaxation function has one row a point, a sweep two: storage first, all of them, then loss
// Units    the viscous column belongs to viscous times the highest omega, so that all unknowns are in [Pa]
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "rheo/prony_fit.hpp"

namespace rheo {

// The unknowns but for their moduli.
struct PronyShape {
  std::vector<double> log_times;  // rising
  bool elastic = false;
  bool viscous = false;

  Eigen::Index moduli() const {
    return static_cast<Eigen::Index>(log_times.size()) + (elastic ? 1 : 0) + (viscous ? 1 : 0);
  }
  Eigen::Index parameters() const { return static_cast<Eigen::Index>(log_times.size()) + moduli(); }
};

// A shape with its best moduli >= 0: of the terms, then elastic, then viscous.
struct PronyGuess {
  PronyShape shape;
  Eigen::VectorXd moduli;
  double squares = 0.0;  // of the residuals
};

class PronyProblem {
 public:
  enum class Kind { relaxation, sweep };

  // x: times [s], or omega [rad/s]; measured, weights (1 / scale of the error times the root of how many
  // points a row stands for): rows.
  PronyProblem(Kind kind, Eigen::VectorXd x, const Eigen::VectorXd& measured, Eigen::VectorXd weights);

  Kind kind() const { return kind_; }
  Eigen::Index rows() const { return weights_.size(); }
  const std::array<double, 2>& log_time_range() const { return range_; }
  double highest_x() const { return highest_x_; }

  // Scaled as the residuals are.
  Eigen::VectorXd column(double log_time) const;
  Eigen::VectorXd column_slope(double log_time) const;  // its derivative by log_time
  Eigen::VectorXd elastic_column() const;
  Eigen::VectorXd viscous_column() const;
  Eigen::MatrixXd columns(const PronyShape& shape) const;
  const Eigen::VectorXd& measured() const { return measured_; }

  // The best moduli for the shape's times.
  PronyGuess solve(PronyShape shape) const;
  // Times and moduli refined together from there; not worse than the guess. `rough`: enough to compare
  // shapes.
  enum class Effort { rough, full };
  PronyGuess refine(const PronyGuess& guess, Effort effort) const;

 private:
  Kind kind_;
  Eigen::VectorXd x_, measured_, weights_;
  std::array<double, 2> range_{};
  double highest_x_ = 0.0;
};

}  // namespace rheo
