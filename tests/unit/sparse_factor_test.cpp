// The sparse factor of 2 x 2 blocks against dense algebra on random patterns, and what it refuses.

#include "sparse_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <random>
#include <set>

namespace rheo {
namespace {

struct Problem {
  BlockPattern pattern;
  std::vector<Block> values;
  Eigen::MatrixXd dense;
};

// A symmetric positive definite matrix on a random connected graph: S = sum over edges of (x_i - x_j)^T C
// (x_i - x_j) with positive definite C, and a diagonal of `mass`.
Problem random_problem(int nodes, int extra_edges, double mass, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Problem p;
  p.dense = mass * Eigen::MatrixXd::Identity(2 * nodes, 2 * nodes);
  std::set<std::pair<int, int>> entries;
  for (int i = 0; i < nodes; ++i) entries.insert({i, i});
  const auto connect = [&](int i, int j) {
    if (i == j) return;
    Eigen::Matrix2d g;
    g << unit(random), unit(random), unit(random), unit(random);
    const Eigen::Matrix2d c = g * g.transpose() + 0.1 * Eigen::Matrix2d::Identity();
    p.dense.block<2, 2>(2 * i, 2 * i) += c;
    p.dense.block<2, 2>(2 * j, 2 * j) += c;
    p.dense.block<2, 2>(2 * i, 2 * j) -= c;
    p.dense.block<2, 2>(2 * j, 2 * i) -= c;
    entries.insert({i, j});
    entries.insert({j, i});
  };
  std::uniform_int_distribution<int> any(0, nodes - 1);
  for (int i = 1; i < nodes; ++i) connect(i, any(random) % i);
  for (int k = 0; k < extra_edges; ++k) connect(any(random), any(random));
  p.pattern.start.assign(1, 0);
  for (int i = 0; i < nodes; ++i) {
    for (auto it = entries.lower_bound({i, 0}); it != entries.end() && it->first == i; ++it) {
      const int j = it->second;
      p.pattern.column.push_back(j);
      p.values.push_back({p.dense(2 * i, 2 * j), p.dense(2 * i, 2 * j + 1), p.dense(2 * i + 1, 2 * j),
                          p.dense(2 * i + 1, 2 * j + 1)});
    }
    p.pattern.start.push_back(static_cast<int>(p.pattern.column.size()));
  }
  return p;
}

TEST(SparseFactor, SolvesAsDenseAlgebraDoes) {
  for (const auto& [nodes, extra] : {std::pair{1, 0}, {2, 0}, {3, 3}, {20, 10}, {60, 150}, {200, 300}}) {
    const Problem p = random_problem(nodes, extra, 0.5, static_cast<unsigned>(nodes));
    SparseFactor factor(std::make_shared<FactorOrder>(p.pattern));
    ASSERT_TRUE(factor.factor(p.values));
    const Eigen::VectorXd right = Eigen::VectorXd::Random(2 * nodes);
    Eigen::VectorXd x = right;
    factor.solve({x.data(), static_cast<std::size_t>(x.size())});
    const Eigen::VectorXd exact = p.dense.ldlt().solve(right);
    // Condition about 100.
    EXPECT_LE((x - exact).norm(), 1e-13 * exact.norm()) << nodes;
  }
}

TEST(SparseFactor, TakesNewValuesOnTheSamePattern) {
  Problem p = random_problem(40, 60, 0.5, 3);
  const auto order = std::make_shared<FactorOrder>(p.pattern);
  SparseFactor first(order), second(order);
  ASSERT_TRUE(first.factor(p.values));
  for (Block& block : p.values) {
    for (double& value : block) value *= 4.0;
  }
  ASSERT_TRUE(second.factor(p.values));
  ASSERT_TRUE(first.factor(p.values));  // again in the same memory
  const Eigen::VectorXd right = Eigen::VectorXd::Random(80);
  Eigen::VectorXd x = right, y = right;
  first.solve({x.data(), 80});
  second.solve({y.data(), 80});
  EXPECT_EQ(x, y);
  // The dense matrix has the first values. Condition about 100.
  EXPECT_LE((p.dense * (4.0 * x) - right).norm(), 1e-12 * right.norm());
}

TEST(SparseFactor, KeepsARowOfNodesWithoutFill) {
  BlockPattern chain;
  chain.start.assign(1, 0);
  constexpr int nodes = 50;
  for (int i = 0; i < nodes; ++i) {
    for (const int j : {i - 1, i, i + 1}) {
      if (j >= 0 && j < nodes) chain.column.push_back(j);
    }
    chain.start.push_back(static_cast<int>(chain.column.size()));
  }
  // L: one number a node and a block of 4 between neighbours, 12 bytes each; 28 bytes a degree of freedom.
  EXPECT_EQ(SparseFactor(std::make_shared<FactorOrder>(chain)).bytes(),
            12u * (nodes + 4 * (nodes - 1)) + 28u * 2 * nodes);
}

TEST(SparseFactor, RefusesWhatRoundingLeftNothingOf) {
  // Without mass the sum of all rows is zero: the last pivot is rounding.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem p = random_problem(30, 40, 0.0, seed);
    EXPECT_FALSE(SparseFactor(std::make_shared<FactorOrder>(p.pattern)).factor(p.values)) << seed;
  }
  Problem p = random_problem(4, 2, 1.0, 1);
  p.values[0] = {-1.0, 0.0, 0.0, 1.0};
  EXPECT_FALSE(SparseFactor(std::make_shared<FactorOrder>(p.pattern)).factor(p.values));
}

}  // namespace
}  // namespace rheo
