#include "kernels/parallel_element_body.hpp"

#include <algorithm>
#include <utility>

#include "kernels/element_body.hpp"
#include "kernels/node_blocks.hpp"

namespace rheo {

namespace {

std::vector<SlotRun> runs_of(const ElementForm& form, const std::vector<ElementForm::Block>& blocks) {
  std::vector<SlotRun> runs;
  for (const ElementForm::Block& block : blocks) {
    for (std::int32_t r = block.first_run; r < block.last_run; ++r) {
      const ElementForm::Run& run = form.runs[r];
      const std::int32_t first = std::max(run.first, block.first_node);
      const std::int32_t last = std::min(run.last, block.last_node);
      const auto node = static_cast<std::size_t>(first);
      const auto slot = static_cast<std::size_t>(run.slot + (first - run.first) * run.slots_a_node);
      if (run.slots_a_node == 1) {
        runs.push_back({slot, node, last - first, static_cast<std::size_t>(run.region)});
        continue;
      }
      for (std::size_t s = slot; s < slot + static_cast<std::size_t>(run.slots_a_node); ++s)
        runs.push_back({s, node, 1, static_cast<std::size_t>(form.slot_region[s])});
    }
  }
  return runs;
}

}  // namespace

ParallelElementBody::ParallelElementBody(const Model& model, const ElementForce& force, int threads)
    : ParallelBody(model, force.form().mesh_node, force.form().kernel_node,
                   block_ends(force.form().blocks(smallest_block)),
                   paying_threads(force.form().nodes, threads),
                   runs_of(force.form(), force.form().blocks(smallest_block))),
      element_force_(force),
      form_(force.form()),
      blocks_(form_.blocks(smallest_block)),
      force_sums_(force, blocks_, team().threads()),
      sums_(blocks_.size() * form_.materials.size()) {}

void ParallelElementBody::sweep_force(const SweepArrays& a, double h, const BlockVisit& visit) {
  const ElementForm::Block& b = blocks_[visit.block];
  double* force = force_sums_.of_block(a.x_p, visit);
  for (std::int32_t r = b.first_run; r < b.last_run; ++r) {
    const ElementForm::Run& run = form_.runs[r];
    const std::int32_t first = std::max(run.first, b.first_node);
    const std::int32_t last = std::min(run.last, b.last_node);
    const auto n = static_cast<std::size_t>(first);
    const auto slot = static_cast<std::size_t>(run.slot + (first - run.first) * run.slots_a_node);
    if (run.slots_a_node > 1) {
      advance_interface(run, h, a, force);
      continue;
    }
    const SweepArrays arrays{a.x_p + 4 * slot,    a.x_v + 2 * n,
                             a.base_p + 4 * slot, a.base_v + 2 * n,
                             a.out_p + 4 * slot,  a.out_v + 2 * n,
                             a.base_u + 2 * n,    a.out_u == nullptr ? nullptr : a.out_u + 2 * n};
    element_force_.sweep().advance({last - first, arrays, inverse_mass() + 2 * n, force + 2 * slot},
                                   SweepMaterial{}, h);
  }
}

// One node of several slots.
void ParallelElementBody::advance_interface(const ElementForm::Run& run, double h, const SweepArrays& a,
                                            double* force) const {
  const auto node = static_cast<std::size_t>(run.first);
  double* of_slot = force + 2 * static_cast<std::size_t>(run.slot);
  for (std::size_t i = 2 * node; i < 2 * node + 2; ++i) {
    double sum = 0.0;
    for (std::int32_t s = 0; s < run.slots_a_node; ++s)
      sum += std::exchange(of_slot[2 * s + static_cast<std::int32_t>(i % 2)], 0.0);
    const double velocity = a.x_v[i];
    a.out_v[i] = a.base_v[i] - h * (inverse_mass()[i] * sum);
    if (a.out_u != nullptr) a.out_u[i] = a.base_u[i] + h * velocity;
  }
}

// x^T J_lambda w_l = sum of div x div w, x^T J_mu w_m = sum of 2 xx xx + 2 yy yy + (xy + yx) (xy + yx), by
// triangle; the gradients carry the square root of the volume.
void ParallelElementBody::forms_of(const double* w, std::size_t stride, const double* x,
                                   std::span<Forms> forms) {
  const std::size_t mu = stride == 4 ? 2 : 0;
  const std::size_t regions = forms.size();
  std::fill(sums_.begin(), sums_.end(), Forms{});
  team().chain(1, [&](const BlockVisit& at) {
    const ElementForm::Block& block = blocks_[at.block];
    Forms* const of_region = sums_.data() + at.block * regions;
    Forms sums;  // of the region that the triangles are of
    std::size_t region = 0;
    for (std::int64_t e = block.first_triangle; e < block.last_triangle; ++e) {
      const auto& q = form_.gradient[e];
      double dx[6] = {}, dy[6] = {};  // d/dx and d/dy of l, m, x
      const auto place = [&](std::size_t corner) {
        const std::size_t slot = form_.offset[e][corner] / 4;
        const auto node = static_cast<std::size_t>(form_.slot_node[slot]);
        return std::array<std::size_t, 2>{stride == 4 ? slot : node, node};
      };
      const auto [wi, i] = place(0);
      for (std::size_t corner : {1u, 2u}) {
        const auto [wj, j] = place(corner);
        const double b = q[2 * (corner - 1)], c = q[2 * (corner - 1) + 1];
        for (std::size_t k = 0; k < 2; ++k) {
          const double l = w[stride * wj + k] - w[stride * wi + k];
          const double m = w[stride * wj + mu + k] - w[stride * wi + mu + k];
          const double other = x[2 * j + k] - x[2 * i + k];
          dx[k] += b * l, dy[k] += c * l;
          dx[2 + k] += b * m, dy[2 + k] += c * m;
          dx[4 + k] += b * other, dy[4 + k] += c * other;
        }
      }
      const double l = dx[0] + dy[1];
      const double mx = dx[2], my = dy[3], ms = dx[3] + dy[2];
      if (regions > 1) {
        const auto next = static_cast<std::size_t>(form_.slot_region[form_.offset[e][0] / 4]);
        if (next != region) {
          of_region[std::exchange(region, next)] = sums;
          sums = of_region[region];
        }
      }
      sums.ll += l * l;
      sums.mm += 2 * (mx * mx + my * my) + ms * ms;
      sums.xl += (dx[4] + dy[5]) * l;
      sums.xm += 2 * (dx[4] * mx + dy[5] * my) + (dx[5] + dy[4]) * ms;
    }
    of_region[region] = sums;
  });
  std::fill(forms.begin(), forms.end(), Forms{});
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    Forms& all = forms[k % regions];
    all.ll += sums_[k].ll;
    all.mm += sums_[k].mm;
    all.xl += sums_[k].xl;
    all.xm += sums_[k].xm;
  }
}

// Only constrained nodes are asked for, a few: triangle by triangle, not by a sweep over the mesh.
std::array<double, 2> ParallelElementBody::force_of(const double* rows, std::size_t node) const {
  std::array<double, 2> f{};
  for (const std::int32_t e : form_.triangles_at(node)) {
    const std::array<double, 4>& q = form_.gradient[e];
    std::array<const double*, 3> w{};
    double b = 0.0, c = 0.0;  // of this node's corner
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t slot = form_.offset[e][k] / 4;
      w[k] = rows + 4 * slot;
      if (static_cast<std::size_t>(form_.slot_node[slot]) != node) continue;
      b = k == 0 ? -(q[0] + q[2]) : q[2 * (k - 1)];
      c = k == 0 ? -(q[1] + q[3]) : q[2 * (k - 1) + 1];
    }
    const auto dx = [&](std::size_t i) { return q[0] * (w[1][i] - w[0][i]) + q[2] * (w[2][i] - w[0][i]); };
    const auto dy = [&](std::size_t i) { return q[1] * (w[1][i] - w[0][i]) + q[3] * (w[2][i] - w[0][i]); };
    const double div = dx(0) + dy(1);
    const double xx = div + 2 * dx(2), yy = div + 2 * dy(3), xy = dx(3) + dy(2);
    f[0] += b * xx + c * xy;
    f[1] += b * xy + c * yy;
  }
  return f;
}

}  // namespace rheo
