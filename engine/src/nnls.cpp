#include "nnls.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <vector>

namespace rheo {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Least squares over the columns of `free` alone.
VectorXd solve_over(const MatrixXd& a, const VectorXd& b, const std::vector<Index>& free) {
  MatrixXd columns(a.rows(), static_cast<Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) columns.col(static_cast<Index>(k)) = a.col(free[k]);
  return columns.colPivHouseholderQr().solve(b);
}

// A of unit columns, as tall as it is wide.
VectorXd solve_square(const MatrixXd& a, const VectorXd& b) {
  const Index n = a.cols();
  const double tolerance = 64.0 * std::numeric_limits<double>::epsilon() * b.norm();
  VectorXd x = VectorXd::Zero(n);
  std::vector<Index> free;
  std::vector<bool> barred(static_cast<std::size_t>(n), false);  // of no use at this x, but for rounding
  for (Index round = 0; round < 10 * n; ++round) {
    const VectorXd descent = a.transpose() * (b - a * x);
    Index best = -1;
    for (Index j = 0; j < n; ++j) {
      const bool candidate =
          !barred[static_cast<std::size_t>(j)] && std::find(free.begin(), free.end(), j) == free.end();
      if (candidate && descent[j] > tolerance && (best < 0 || descent[j] > descent[best])) best = j;
    }
    if (best < 0) break;
    free.push_back(best);
    bool moved = false;
    while (!free.empty()) {
      const VectorXd goal = solve_over(a, b, free);
      if (!moved && goal[static_cast<Index>(free.size()) - 1] <= 0.0) break;  // the new one, by rounding
      moved = true;
      // As far towards the goal as all stay >= 0.
      double share = 1.0;
      std::size_t stop = free.size();  // which of them reaches 0 first
      for (std::size_t k = 0; k < free.size(); ++k) {
        const double from = x[free[k]], to = goal[static_cast<Index>(k)];
        if (to > 0.0 || from / (from - to) >= share) continue;
        share = from / (from - to);
        stop = k;
      }
      for (std::size_t k = 0; k < free.size(); ++k) {
        double& value = x[free[k]];
        value = k == stop ? 0.0 : std::max(0.0, value + share * (goal[static_cast<Index>(k)] - value));
      }
      if (stop == free.size()) break;
      std::erase_if(free, [&](Index j) { return x[j] <= 0.0; });
    }
    if (moved) {
      std::fill(barred.begin(), barred.end(), false);
    } else {
      free.pop_back();
      barred[static_cast<std::size_t>(best)] = true;
    }
  }
  return x;
}

}  // namespace

VectorXd nonnegative_least_squares(const MatrixXd& a, const VectorXd& b) {
  const Index n = a.cols();
  VectorXd norms = a.colwise().norm().transpose();
  MatrixXd unit = a;
  for (Index j = 0; j < n; ++j) {
    if (norms[j] > 0.0)
      unit.col(j) /= norms[j];
    else
      norms[j] = 1.0;
  }
  VectorXd x;
  if (a.rows() > n) {
    const Eigen::HouseholderQR<MatrixXd> qr(unit);
    const VectorXd right = (qr.householderQ().adjoint() * b).head(n);
    x = solve_square(qr.matrixQR().topRows(n).triangularView<Eigen::Upper>(), right);
  } else {
    x = solve_square(unit, b);
  }
  return x.cwiseQuotient(norms);
}

}  // namespace rheo
