#include "sparse_factor.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace rheo {
namespace {

// A pivot below this part of its diagonal is what rounding left of it.
constexpr double vanished = 64.0 * std::numeric_limits<double>::epsilon();

// The order of elimination: order[place] = node.
std::vector<int> least_degree_order(const BlockPattern& pattern) {
  const int n = pattern.nodes();
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(pattern.column.size());
  for (int i = 0; i < n; ++i) {
    for (int p = pattern.start[i]; p < pattern.start[i + 1]; ++p)
      entries.emplace_back(pattern.column[p], i, 1.0);
  }
  Eigen::SparseMatrix<double> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int> amd;
  amd(graph, order);
  const auto& indices = order.indices();
  return {indices.data(), indices.data() + indices.size()};
}

}  // namespace

FactorOrder::FactorOrder(BlockPattern pattern) : pattern_(std::move(pattern)) {
  const int n = pattern_.nodes();
  order_ = least_degree_order(pattern_);
  std::vector<int> place(n);
  for (int k = 0; k < n; ++k) place[order_[k]] = k;

  above_start_.assign(1, 0);
  Eigen::VectorXi entries(2 * n);
  for (int k = 0; k < n; ++k) {
    const int node = order_[k];
    for (int p = pattern_.start[node]; p < pattern_.start[node + 1]; ++p) {
      if (place[pattern_.column[p]] <= k) above_.push_back(p);
    }
    const auto by_place = [&](int p, int q) { return place[pattern_.column[p]] < place[pattern_.column[q]]; };
    std::sort(above_.begin() + above_start_.back(), above_.end(), by_place);
    entries[2 * k] = 2 * (static_cast<int>(above_.size()) - above_start_.back()) - 1;
    entries[2 * k + 1] = entries[2 * k] + 1;
    above_start_.push_back(static_cast<int>(above_.size()));
  }

  pattern_above_.resize(2 * n, 2 * n);
  pattern_above_.reserve(entries);
  for (int k = 0; k < n; ++k) {
    for (int column = 2 * k; column <= 2 * k + 1; ++column) {
      for (int q = above_start_[k]; q < above_start_[k + 1]; ++q) {
        const int first = 2 * place[pattern_.column[above_[q]]];
        for (int row = first; row <= std::min(first + 1, column); ++row)
          pattern_above_.insert(row, column) = 0.0;
      }
    }
  }
  pattern_above_.makeCompressed();
}

Eigen::SparseMatrix<double> FactorOrder::ordered(std::span<const Block> blocks) const {
  Eigen::SparseMatrix<double> s = pattern_above_;
  double* value = s.valuePtr();
  for (int k = 0; k < pattern_.nodes(); ++k) {
    for (int column = 0; column < 2; ++column) {
      for (int q = above_start_[k]; q < above_start_[k + 1]; ++q) {
        // S_ik = S_ki^T; the last block is the diagonal one.
        const Block& block = blocks[above_[q]];
        *value++ = block[2 * column];
        if (column == 1 || q + 1 < above_start_[k + 1]) *value++ = block[2 * column + 1];
      }
    }
  }
  assert(value == s.valuePtr() + s.nonZeros());
  return s;
}

SparseFactor::SparseFactor(std::shared_ptr<const FactorOrder> order)
    : order_(std::move(order)), x_(Eigen::VectorXd::Zero(order_->pattern_above_.rows())) {
  cholesky_.analyzePattern(order_->pattern_above_);
}

std::size_t SparseFactor::bytes() const {
  const auto dofs = static_cast<std::size_t>(x_.size());
  const auto entries = static_cast<std::size_t>(cholesky_.l().nonZeros());
  // Where L's columns begin, their lengths and the tree: an int each; D and x_.
  return entries * (sizeof(double) + sizeof(int)) + dofs * (3 * sizeof(int) + 2 * sizeof(double));
}

bool SparseFactor::factor(std::span<const Block> values) {
  assert(values.size() == pattern().column.size());
  const Eigen::SparseMatrix<double> s = order_->ordered(values);
  cholesky_.factorize(s);
  if (cholesky_.info() != Eigen::Success) return false;
  for (Eigen::Index k = 0; k < s.cols(); ++k) {
    // The diagonal is the last of each column of the upper triangle.
    const double origin = s.valuePtr()[s.outerIndexPtr()[k + 1] - 1];
    if (!(cholesky_.d()[k] > vanished * origin)) return false;  // NaN as well
  }
  return true;
}

void SparseFactor::solve(std::span<double> x) const {
  const std::vector<int>& order = order_->order_;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(2 * k);
    const std::size_t node = 2 * static_cast<std::size_t>(order[k]);
    x_[place] = x[node];
    x_[place + 1] = x[node + 1];
  }
  cholesky_.matrixL().solveInPlace(x_);
  x_.array() /= cholesky_.d().array();
  cholesky_.matrixU().solveInPlace(x_);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(2 * k);
    const std::size_t node = 2 * static_cast<std::size_t>(order[k]);
    x[node] = x_[place];
    x[node + 1] = x_[place + 1];
  }
}

}  // namespace rheo
