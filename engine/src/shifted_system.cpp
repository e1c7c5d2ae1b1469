#include "shifted_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "rheo/error.hpp"

namespace rheo {
namespace {

// Of a known answer, the softest motion there is: a factor that gives less has lost the rest to rounding.
constexpr double digits_needed = 1e-6;

// Of the nodes of a region, or of none where nothing is stiff.
BlockPattern pattern_of(const Patch& patch) {
  const auto n = static_cast<int>(patch.part / 2);
  BlockPattern pattern;
  pattern.start.assign(1, 0);
  const SparseMatrix& stiffness = patch.lambda ? patch.j_lambda : patch.j_mu;
  for (int i = 0; i < n; ++i) {
    if (patch.lambda || patch.mu) {
      for (SparseMatrix::InnerIterator it(stiffness, 2 * i); it; ++it) {
        if (it.col() % 2 == 0) pattern.column.push_back(static_cast<int>(it.col() / 2));
      }
    }
    pattern.start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

BlockPattern pattern_of(const Model& model) {
  const Patch& first = model.patches.front();
  if (!model.has_several_materials() && (first.lambda || first.mu)) return pattern_of(first);
  const auto n = static_cast<int>(model.node_mass.size());
  BlockPattern pattern;
  pattern.start.assign(1, 0);
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(model.has_several_materials() ? n : 0));
  if (model.has_several_materials()) {
    for (const Patch& patch : model.patches) {
      const BlockPattern own = pattern_of(patch);
      for (int k = 0; k < own.nodes(); ++k) {
        std::vector<int>& row = columns[static_cast<std::size_t>(patch.nodes[static_cast<std::size_t>(k)])];
        for (int p = own.start[k]; p < own.start[k + 1]; ++p)
          row.push_back(patch.nodes[static_cast<std::size_t>(own.column[p])]);
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    if (!columns.empty()) {
      std::vector<int>& row = columns[static_cast<std::size_t>(i)];
      row.push_back(i);
      if (!model.is_lumped())
        for (SparseMatrix::InnerIterator it(model.mass, i); it; ++it)
          row.push_back(static_cast<int>(it.col()));
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    } else if (!model.is_lumped()) {
      for (SparseMatrix::InnerIterator it(model.mass, i); it; ++it)
        pattern.column.push_back(static_cast<int>(it.col()));
    } else {
      pattern.column.push_back(i);
    }
    pattern.start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

// Every 2 x 2 block of a connection matrix into the numbers from `offset` on of its link.
void copy_blocks(const BlockPattern& pattern, const SparseMatrix& matrix, std::size_t offset,
                 std::vector<std::array<double, 8>>& links) {
  for (int node = 0; node < pattern.nodes(); ++node) {
    for (int p = pattern.start[node]; p < pattern.start[node + 1]; ++p) {
      for (int row = 0; row < 2; ++row) {
        const double* values =
            matrix.valuePtr() + matrix.outerIndexPtr()[2 * node + row] + 2 * (p - pattern.start[node]);
        links[p][offset + 2 * row] = values[0];
        links[p][offset + 2 * row + 1] = values[1];
      }
    }
  }
}

// By block of a region's pattern: its number in the pattern of the whole mesh.
std::vector<int> places_in(const BlockPattern& whole, const BlockPattern& own, const Patch& patch) {
  std::vector<int> places(own.column.size());
  for (int k = 0; k < own.nodes(); ++k) {
    const int node = patch.nodes[static_cast<std::size_t>(k)];
    const auto begin = whole.column.begin() + whole.start[node];
    const auto end = whole.column.begin() + whole.start[node + 1];
    for (int p = own.start[k]; p < own.start[k + 1]; ++p) {
      const int column = patch.nodes[static_cast<std::size_t>(own.column[p])];
      places[p] = static_cast<int>(std::lower_bound(begin, end, column) - whole.column.begin());
    }
  }
  return places;
}

}  // namespace

void require_few_general_constraints(const Scene& scene) {
  constexpr double memory_limit = 4e9;  // bytes
  // Two factors kept, each while it is made in two copies.
  const auto m = static_cast<double>(scene.constraints.size());
  const double need = 4.0 * m * m * sizeof(double);
  if (need <= memory_limit) return;
  throw Error(Error::Kind::input,
              fmt::format("{} general constraints with integrator = \"implicit\" need about {:.1f} GB, the "
                          "limit is {:.1f} GB: use \"rk4\"",
                          scene.constraints.size(), need * 1e-9, memory_limit * 1e-9));
}

ShiftedSystem::Factor::Factor(double shift, std::shared_ptr<const ConstraintSolver> set,
                              std::unique_ptr<SparseFactor> memory)
    : s(shift), constraints(std::move(set)), sparse(std::move(memory)) {
  const auto dofs = 2 * static_cast<std::size_t>(sparse->pattern().nodes());
  free.resize(dofs);
  for (std::size_t i = 0; i < dofs; ++i) free[i] = constraints->is_free(i) ? 1 : 0;
  const auto& columns = constraints->columns();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const bool one = columns[j].entries.size() == 1;
    (one ? single : general).push_back(static_cast<int>(j));
    if (one) free[columns[j].entries.front().first] = 0;
  }
}

ShiftedSystem::ShiftedSystem(const Model& model)
    : model_(model),
      order_(std::make_shared<FactorOrder>(pattern_of(model))),
      spare_(std::make_unique<SparseFactor>(order_)),
      factor_bytes_(spare_->bytes()) {
  const BlockPattern& pattern = order_->pattern();
  values_.resize(pattern.column.size());
  for (const Patch& patch : model.patches) {
    Links links{pattern_of(patch), {}, {}};
    links.blocks.resize(links.pattern.column.size());
    if (patch.lambda) copy_blocks(links.pattern, patch.j_lambda, 0, links.blocks);
    if (patch.mu) copy_blocks(links.pattern, patch.j_mu, 4, links.blocks);
    if (model.has_several_materials()) links.place = places_in(pattern, links.pattern, patch);
    links_.push_back(std::move(links));
  }
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  work_.setZero(size);
  correction_.setZero(size);
}

ShiftedSystem::Found ShiftedSystem::prepare(double s,
                                            const std::shared_ptr<const ConstraintSolver>& constraints) {
  const auto known = std::find_if(factors_.begin(), factors_.end(), [&](const auto& factor) {
    return factor->s == s && factor->constraints == constraints;
  });
  if (known != factors_.end()) {
    std::rotate(factors_.begin(), known, known + 1);
    current_ = factors_.front().get();
    return Found::kept;
  }
  const double affordable = factors_budget / static_cast<double>(factor_bytes_);
  const double kept = std::clamp<double>(affordable, fewest_factors, most_factors);
  while (static_cast<double>(factors_.size()) + 1.0 > kept) {
    spare_ = std::move(factors_.back()->sparse);
    factors_.pop_back();
  }
  if (!spare_) spare_ = std::make_unique<SparseFactor>(order_);
  factors_.push_front(std::make_unique<Factor>(s, constraints, std::move(spare_)));
  Factor& factor = *factors_.front();
  current_ = &factor;
  fill_values(factor);
  if (factor.sparse->factor(values_) && holds_digits(factor) && factor_schur(factor)) return Found::made;
  spare_ = std::move(factor.sparse);
  factors_.pop_front();
  current_ = nullptr;
  return Found::failed;
}

// S, where driven degrees of freedom have the row and column of the unit matrix.
void ShiftedSystem::fill_values(const Factor& factor) {
  const double s = factor.s;
  std::fill(values_.begin(), values_.end(), Block{});
  for (std::size_t r = 0; r < links_.size(); ++r) {
    const Material& material = model_.patches[r].material;
    double lambda = s * s * material.elastic.lambda + s * material.viscous.lambda;
    double mu = s * s * material.elastic.mu + s * material.viscous.mu;
    for (const BranchPart& branch : model_.layout.branches) {
      if (branch.region != r) continue;
      (branch.modulus == Modulus::lambda ? lambda : mu) += s * s * branch.ela / (1.0 + s * branch.rate);
    }
    const Links& links = links_[r];
    for (std::size_t p = 0; p < links.blocks.size(); ++p) {
      Block& block = values_[links.place.empty() ? p : static_cast<std::size_t>(links.place[p])];
      const std::array<double, 8>& link = links.blocks[p];
      for (std::size_t k = 0; k < 4; ++k) block[k] += lambda * link[k] + mu * link[4 + k];
    }
  }
  const bool consistent = !model_.is_lumped();
  const BlockPattern& pattern = order_->pattern();
  for (int node = 0; node < pattern.nodes(); ++node) {
    for (int p = pattern.start[node]; p < pattern.start[node + 1]; ++p) {
      const int entry = p - pattern.start[node];
      const int column = pattern.column[p];
      Block& block = values_[p];
      const double mass = consistent ? model_.mass.valuePtr()[model_.mass.outerIndexPtr()[node] + entry]
                                     : (column == node ? model_.node_mass[node] : 0.0);
      block[0] += mass;
      block[3] += mass;
      for (int row = 0; row < 2; ++row) {
        for (int col = 0; col < 2; ++col) {
          if (factor.free[2 * node + row] && factor.free[2 * column + col]) continue;
          block[2 * row + col] = column == node && row == col ? 1.0 : 0.0;
        }
      }
    }
  }
}

bool ShiftedSystem::holds_digits(const Factor& factor) {
  // S e for e = 1 on all free degrees of freedom, from the values that were factored.
  const BlockPattern& pattern = order_->pattern();
  for (int node = 0; node < pattern.nodes(); ++node) {
    double x = 0.0, y = 0.0;
    for (int p = pattern.start[node]; p < pattern.start[node + 1]; ++p) {
      const Block& block = values_[p];
      x += block[0] + block[1];
      y += block[2] + block[3];
    }
    work_[2 * node] = x;
    work_[2 * node + 1] = y;
  }
  factor.sparse->solve({work_.data(), static_cast<std::size_t>(work_.size())});
  double largest = 0.0;
  for (Eigen::Index i = 0; i < work_.size(); ++i) largest = std::max(largest, std::abs(work_[i] - 1.0));
  return largest <= digits_needed;  // false for NaN
}

bool ShiftedSystem::factor_schur(Factor& factor) {
  const auto m = static_cast<Eigen::Index>(factor.general.size());
  if (m == 0) return true;
  Eigen::MatrixXd schur(m, m);
  Vector unit = Vector::Zero(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    unit[j] = 1.0;
    spread(factor, unit);
    unit[j] = 0.0;
    factor.sparse->solve({correction_.data(), static_cast<std::size_t>(correction_.size())});
    for (Eigen::Index i = 0; i < m; ++i)
      schur(i, j) = factor.constraints->row_times(factor.general[i], correction_.data());
  }
  factor.schur.compute(schur);
  return factor.schur.info() == Eigen::Success;
}

void ShiftedSystem::spread(const Factor& factor, const Vector& multipliers) {
  correction_.setZero();
  for (std::size_t j = 0; j < factor.general.size(); ++j) {
    for (const auto& [dof, coefficient] : factor.constraints->columns()[factor.general[j]].entries) {
      if (factor.free[dof]) correction_[dof] += coefficient * multipliers[static_cast<Eigen::Index>(j)];
    }
  }
}

void ShiftedSystem::subtract_force(std::size_t region, std::span<const double> pull, Vector& r) const {
  const Links& links = links_[region];
  const BlockPattern& pattern = links.pattern;
  const std::vector<std::int32_t>& nodes = model_.patches[region].nodes;
  for (int node = 0; node < pattern.nodes(); ++node) {
    const double* own = pull.data() + 4 * static_cast<std::size_t>(node);
    double lambda_x = 0.0, lambda_y = 0.0, mu_x = 0.0, mu_y = 0.0;
    for (int p = pattern.start[node]; p < pattern.start[node + 1]; ++p) {
      const double* other = pull.data() + 4 * static_cast<std::size_t>(pattern.column[p]);
      const std::array<double, 8>& link = links.blocks[p];
      const double d0 = other[0] - own[0], d1 = other[1] - own[1];
      const double d2 = other[2] - own[2], d3 = other[3] - own[3];
      lambda_x += link[0] * d0 + link[1] * d1;
      lambda_y += link[2] * d0 + link[3] * d1;
      mu_x += link[4] * d2 + link[5] * d3;
      mu_y += link[6] * d2 + link[7] * d3;
    }
    const Eigen::Index dof = 2 * (nodes.empty() ? node : nodes[static_cast<std::size_t>(node)]);
    r[dof] -= lambda_x + mu_x;
    r[dof + 1] -= lambda_y + mu_y;
  }
}

int ShiftedSystem::solve(Vector& r, Vector& d, Vector& target) {
  assert(current_ != nullptr);
  const Factor& factor = *current_;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    if (!factor.free[i]) r[i] = 0.0;
  }
  factor.sparse->solve({r.data(), static_cast<std::size_t>(r.size())});
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    if (factor.free[i]) d[i] = r[i];
  }
  if (factor.general.empty()) return 1;
  for (std::size_t j = 0; j < factor.general.size(); ++j)
    target[static_cast<Eigen::Index>(j)] -= factor.constraints->row_times(factor.general[j], d.data());
  factor.schur.solveInPlace(target);
  spread(factor, target);
  factor.sparse->solve({correction_.data(), static_cast<std::size_t>(correction_.size())});
  d += correction_;
  return 2;
}

}  // namespace rheo
