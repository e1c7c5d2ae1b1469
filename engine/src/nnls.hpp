// Non-negative least squares by an active set: x >= 0 that minimises |A x - b|.
//
// At the solution the gradient A^T (A x - b) is 0 where x > 0 and >= 0 where x = 0, to rounding.
//
// Source   Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23
// Shapes   A: m x n, b: m, x: n
// Errors   none; columns of zeros get x = 0
#pragma once

#include <Eigen/Core>

namespace rheo {

Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace rheo
