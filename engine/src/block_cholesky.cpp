#include "block_cholesky.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace rheo {
namespace {

// A pivot below this part of its diagonal is what rounding left of it.
constexpr double vanished = 64.0 * std::numeric_limits<double>::epsilon();

// c -= a b^T
void subtract_product(Block& c, const Block& a, const Block& b) {
  c[0] -= a[0] * b[0] + a[1] * b[1];
  c[1] -= a[0] * b[2] + a[1] * b[3];
  c[2] -= a[2] * b[0] + a[3] * b[1];
  c[3] -= a[2] * b[2] + a[3] * b[3];
}

// a b^T for a lower triangular b
Block times_lower_transposed(const Block& a, const Block& b) {
  return {a[0] * b[0], a[0] * b[2] + a[1] * b[3], a[2] * b[0], a[2] * b[2] + a[3] * b[3]};
}

// L^-1 of S = L L^T; false where S is not positive definite beyond the rounding of the diagonal it came from.
bool inverse_factor(const Block& s, const Block& origin, Block& inverse) {
  if (!(s[0] > vanished * origin[0])) return false;
  const double l00 = std::sqrt(s[0]);
  const double l10 = s[2] / l00;
  const double rest = s[3] - l10 * l10;
  if (!(rest > vanished * origin[3])) return false;
  const double l11 = std::sqrt(rest);
  inverse = {1.0 / l00, 0.0, -l10 / (l00 * l11), 1.0 / l11};
  return std::isfinite(inverse[0]) && std::isfinite(inverse[2]) && std::isfinite(inverse[3]);
}

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

BlockAnalysis::BlockAnalysis(BlockPattern pattern) : pattern_(std::move(pattern)) {
  const int n = pattern_.nodes();
  order_ = least_degree_order(pattern_);
  place_.resize(n);
  for (int k = 0; k < n; ++k) place_[order_[k]] = k;

  // The elimination tree, paths shortened on the way up.
  parent_.assign(n, -1);
  std::vector<int> ancestor(n, -1);
  for (int k = 0; k < n; ++k) {
    const int node = order_[k];
    for (int p = pattern_.start[node]; p < pattern_.start[node + 1]; ++p) {
      for (int i = place_[pattern_.column[p]]; i != -1 && i < k;) {
        const int next = ancestor[i];
        ancestor[i] = k;
        if (next == -1) parent_[i] = k;
        i = next;
      }
    }
  }

  std::vector<int> stack(n), mark(n, -1);
  column_start_.assign(n + 1, 0);
  for (int k = 0; k < n; ++k) {
    for (int top = reach(k, stack, mark); top < n; ++top) ++column_start_[stack[top] + 1];
  }
  for (int k = 0; k < n; ++k) column_start_[k + 1] += column_start_[k];
}

std::size_t BlockAnalysis::factor_bytes() const {
  return fill() * (sizeof(Block) + sizeof(int)) + order_.size() * (sizeof(Block) + 2 * sizeof(double));
}

int BlockAnalysis::reach(int k, std::span<int> stack, std::span<int> mark) const {
  const int n = pattern_.nodes();
  int top = n;
  mark[k] = k;
  const int node = order_[k];
  for (int p = pattern_.start[node]; p < pattern_.start[node + 1]; ++p) {
    int i = place_[pattern_.column[p]];
    if (i > k) continue;
    int length = 0;
    for (; mark[i] != k; i = parent_[i]) {
      stack[length++] = i;
      mark[i] = k;
    }
    while (length > 0) stack[--top] = stack[--length];
  }
  return top;
}

BlockCholesky::BlockCholesky(std::shared_ptr<const BlockAnalysis> analysis)
    : analysis_(std::move(analysis)),
      row_(analysis_->fill()),
      below_(analysis_->fill()),
      diagonal_(analysis_->order_.size()),
      x_(2 * analysis_->order_.size()) {}

bool BlockCholesky::factor(std::span<const Block> values) {
  const BlockAnalysis& a = *analysis_;
  const BlockPattern& pattern = a.pattern_;
  assert(values.size() == pattern.column.size());
  const int n = pattern.nodes();
  std::vector<int> stack(n), mark(n, -1);
  std::vector<Block> x(n, Block{});  // row k of S, of which L's blocks are being taken off
  std::vector<std::size_t> end(a.column_start_.begin(), a.column_start_.end() - 1);
  for (int k = 0; k < n; ++k) {
    int top = a.reach(k, stack, mark);
    const int node = a.order_[k];
    for (int p = pattern.start[node]; p < pattern.start[node + 1]; ++p) {
      const int i = a.place_[pattern.column[p]];
      if (i <= k) x[i] = values[p];
    }
    Block left = std::exchange(x[k], Block{});
    const Block origin = left;
    for (; top < n; ++top) {
      const int i = stack[top];
      const Block l = times_lower_transposed(std::exchange(x[i], Block{}), diagonal_[i]);
      std::size_t p = a.column_start_[i];
      for (; p < end[i]; ++p) subtract_product(x[row_[p]], l, below_[p]);
      subtract_product(left, l, l);
      row_[p] = k;
      below_[p] = l;
      end[i] = p + 1;
    }
    if (!inverse_factor(left, origin, diagonal_[k])) return false;
  }
  return true;
}

void BlockCholesky::solve(std::span<double> x) const {
  const BlockAnalysis& a = *analysis_;
  const int n = a.pattern_.nodes();
  for (int k = 0; k < n; ++k) {
    x_[2 * k] = x[2 * a.order_[k]];
    x_[2 * k + 1] = x[2 * a.order_[k] + 1];
  }
  double* y = x_.data();
  for (int k = 0; k < n; ++k) {
    const Block& d = diagonal_[k];
    const double y0 = d[0] * y[2 * k];
    const double y1 = d[2] * y[2 * k] + d[3] * y[2 * k + 1];
    y[2 * k] = y0;
    y[2 * k + 1] = y1;
    for (std::size_t p = a.column_start_[k]; p < a.column_start_[k + 1]; ++p) {
      const Block& l = below_[p];
      double* z = y + 2 * static_cast<std::size_t>(row_[p]);
      z[0] -= l[0] * y0 + l[1] * y1;
      z[1] -= l[2] * y0 + l[3] * y1;
    }
  }
  for (int k = n; k-- > 0;) {
    double y0 = y[2 * k], y1 = y[2 * k + 1];
    for (std::size_t p = a.column_start_[k]; p < a.column_start_[k + 1]; ++p) {
      const Block& l = below_[p];
      const double* z = y + 2 * static_cast<std::size_t>(row_[p]);
      y0 -= l[0] * z[0] + l[2] * z[1];
      y1 -= l[1] * z[0] + l[3] * z[1];
    }
    const Block& d = diagonal_[k];
    y[2 * k] = d[0] * y0 + d[2] * y1;
    y[2 * k + 1] = d[3] * y1;
  }
  for (int k = 0; k < n; ++k) {
    x[2 * a.order_[k]] = y[2 * k];
    x[2 * a.order_[k] + 1] = y[2 * k + 1];
  }
}

}  // namespace rheo
