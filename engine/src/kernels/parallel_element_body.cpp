#include "kernels/parallel_element_body.hpp"

#include <algorithm>
#include <cassert>

#include "kernels/element_body.hpp"
#include "kernels/node_blocks.hpp"

namespace rheo {

ParallelElementBody::ParallelElementBody(const Model& model, const ElementForce& force, int threads)
    : ParallelBody(model, force.form().mesh_node, force.form().kernel_node,
                   block_ends(element_blocks(force.form(), threads)),
                   paying_threads(force.form().nodes, threads)),
      element_force_(force),
      form_(force.form()),
      blocks_(element_blocks(form_, threads)),
      stretches_(form_.blocks(smallest_block)),
      stretch_team_(block_ends(stretches_), team().threads()),
      sums_(stretches_.size()) {
  assert(form_.slots == form_.nodes);
  forces_.assign(team().threads() > 1 ? 3 : 1, std::vector<double>(2 * nodes(), 0.0));
}

// A node's force is the sum over its triangles in their order, in both of the ways: those of the block before
// come first.
void ParallelElementBody::sweep_force(const SweepArrays& a, double h, std::size_t block) {
  const ElementForm::Block& b = blocks_[block];
  double* force = forces_[block % forces_.size()].data();
  if (forces_.size() > 1) {
    const auto begin = static_cast<std::size_t>(blocks_[block > 0 ? block - 1 : 0].first_node);
    const auto end = static_cast<std::size_t>(blocks_[std::min(block + 1, blocks_.size() - 1)].last_node);
    std::fill(force + 2 * begin, force + 2 * end, 0.0);
    element_force_.sweep().add_forces(form_, a.x_p, force, b.reaching, b.first_triangle);
  }
  element_force_.sweep().add_forces(form_, a.x_p, force, b.first_triangle, b.last_triangle);
  const auto n = static_cast<std::size_t>(b.first_node);
  const SweepArrays arrays{
      a.x_p + 4 * n,   a.x_v + 2 * n,   a.base_p + 4 * n, a.base_v + 2 * n,
      a.out_p + 4 * n, a.out_v + 2 * n, a.base_u + 2 * n, a.out_u == nullptr ? nullptr : a.out_u + 2 * n};
  element_force_.sweep().advance({b.last_node - b.first_node, arrays, inverse_mass() + 2 * n, force + 2 * n},
                                 SweepMaterial{}, h);
}

// x^T J_lambda w_l = sum of div x div w, x^T J_mu w_m = sum of 2 xx xx + 2 yy yy + (xy + yx) (xy + yx), by
// triangle; the gradients carry the square root of the volume.
ParallelBody::Forms ParallelElementBody::forms_of(const double* w, std::size_t stride, const double* x) {
  const std::size_t mu = stride == 4 ? 2 : 0;
  stretch_team_.chain(1, [&](std::size_t, std::size_t block) {
    Forms sums;
    for (std::int64_t e = stretches_[block].first_triangle; e < stretches_[block].last_triangle; ++e) {
      const auto& q = form_.gradient[e];
      double dx[6] = {}, dy[6] = {};  // d/dx and d/dy of l, m, x
      const std::size_t i = form_.offset[e][0] / 4;
      for (std::size_t corner : {1u, 2u}) {
        const std::size_t j = form_.offset[e][corner] / 4;
        const double b = q[2 * (corner - 1)], c = q[2 * (corner - 1) + 1];
        for (std::size_t k = 0; k < 2; ++k) {
          const double l = w[stride * j + k] - w[stride * i + k];
          const double m = w[stride * j + mu + k] - w[stride * i + mu + k];
          const double other = x[2 * j + k] - x[2 * i + k];
          dx[k] += b * l, dy[k] += c * l;
          dx[2 + k] += b * m, dy[2 + k] += c * m;
          dx[4 + k] += b * other, dy[4 + k] += c * other;
        }
      }
      const double l = dx[0] + dy[1];
      const double mx = dx[2], my = dy[3], ms = dx[3] + dy[2];
      sums.ll += l * l;
      sums.mm += 2 * (mx * mx + my * my) + ms * ms;
      sums.xl += (dx[4] + dy[5]) * l;
      sums.xm += 2 * (dx[4] * mx + dy[5] * my) + (dx[5] + dy[4]) * ms;
    }
    sums_[block] = sums;
  });
  Forms all;
  for (const Forms& sums : sums_) {
    all.ll += sums.ll;
    all.mm += sums.mm;
    all.xl += sums.xl;
    all.xm += sums.xm;
  }
  return all;
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
      if (slot != node) continue;
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
