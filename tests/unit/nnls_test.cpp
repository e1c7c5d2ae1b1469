#include "nnls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rheo {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Karush, Kuhn and Tucker: the gradient is 0 where x > 0, and >= 0 where x = 0.
void expect_solution(const MatrixXd& a, const VectorXd& b) {
  const VectorXd x = nonnegative_least_squares(a, b);
  ASSERT_EQ(x.size(), a.cols());
  const VectorXd gradient = a.transpose() * (a * x - b);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double rounding = 1e-11 * a.col(j).norm() * b.norm();
    EXPECT_GE(x[j], 0.0);
    EXPECT_GE(gradient[j], -rounding) << j;
    if (x[j] > 0.0) {
      EXPECT_LE(gradient[j], rounding) << j;
    }
  }
}

TEST(Nnls, SolutionsAreStationary) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto& [rows, columns] : {std::pair{5, 3}, {40, 12}, {8, 8}, {6, 15}, {300, 60}}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      const MatrixXd a = MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
      const VectorXd b = VectorXd::NullaryExpr(rows, [&] { return normal(random); });
      expect_solution(a, b);
    }
  }
}

// Neighbouring columns that hardly differ, as a grid of relaxation times has them.
TEST(Nnls, SolvesGridsOfDecays) {
  const int rows = 200, columns = 80;
  MatrixXd a(rows, columns);
  VectorXd b(rows);
  for (int i = 0; i < rows; ++i) {
    const double t = std::pow(10.0, -2.0 + 5.0 * i / rows);
    for (int j = 0; j < columns; ++j) a(i, j) = std::exp(-t / std::pow(10.0, -3.0 + 0.1 * j));
    b[i] = 100.0 * std::pow(1.0 + t, -0.4);
  }
  expect_solution(a, b);
  const VectorXd x = nonnegative_least_squares(a, b);
  EXPECT_LT((a * x - b).norm(), 1e-4 * b.norm());
}

TEST(Nnls, FindsTheSolutionThatIsThere) {
  MatrixXd a(3, 2);
  a << 1, 2, 3, 4, 5, 7;
  const VectorXd x = nonnegative_least_squares(a, a * Eigen::Vector2d(2.0, 3.0));
  EXPECT_NEAR(x[0], 2.0, 1e-12);
  EXPECT_NEAR(x[1], 3.0, 1e-12);
}

TEST(Nnls, LeavesOutColumnsThatPointAwayAndZeros) {
  MatrixXd a(2, 3);
  a << -1, 0, 1, -1, 0, 0;
  const VectorXd x = nonnegative_least_squares(a, Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(x[0], 0.0);
  EXPECT_EQ(x[1], 0.0);
  EXPECT_NEAR(x[2], 1.0, 1e-15);
}

}  // namespace
}  // namespace rheo
