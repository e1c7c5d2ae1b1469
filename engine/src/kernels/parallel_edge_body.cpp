#include "kernels/parallel_edge_body.hpp"

#include <algorithm>

#include "kernels/node_blocks.hpp"

namespace rheo {

namespace {

// One material: slots are nodes.
std::vector<SlotRun> runs_of(const EdgeForm& form) {
  std::vector<SlotRun> runs;
  std::size_t first = 0;
  for (const std::int32_t end : block_ends(form.blocks)) {
    runs.push_back({first, first, end - static_cast<std::int64_t>(first), 0});
    first = static_cast<std::size_t>(end);
  }
  return runs;
}

}  // namespace

ParallelEdgeBody::ParallelEdgeBody(const Model& model, const EdgeForce& force, int threads)
    : ParallelBody(model, force.form().mesh_node, force.form().kernel_node, block_ends(force.form().blocks),
                   paying_threads(force.form().nodes, threads), runs_of(force.form())),
      edge_force_(force),
      form_(force.form()),
      sums_(form_.blocks.size()) {
  find_block_begins(
      block_ends(form_.blocks), form_.corners,
      [](const EdgeForm::Corner& corner) { return static_cast<std::size_t>(corner.node); }, corner_begin_);
}

void ParallelEdgeBody::sweep_force(const SweepArrays& arrays, double h, const BlockVisit& visit) {
  const std::size_t block = visit.block;
  const EdgeForm::Block& b = form_.blocks[block];
  edge_force_.sweep()(form_, inverse_mass(), SweepMaterial{}, h, arrays, b.first_run, b.last_run);
  edge_force_.subtract_boundary(h, inverse_mass(), arrays.x_p, arrays.out_v, corner_begin_[block],
                                corner_begin_[block + 1]);
}

void ParallelEdgeBody::forms_of(const double* w, std::size_t stride, const double* x,
                                std::span<Forms> forms) {
  const EdgeFormsFunction edges = stride == 4 ? edge_force_.forms().rows : edge_force_.forms().both;
  team().chain(1, [&](const BlockVisit& at) {
    const EdgeForm::Block& b = form_.blocks[at.block];
    sums_[at.block] = edges(form_, w, x, b.first_run, b.last_run);
  });
  EdgeForms all = boundary_forms(form_, w, stride, x);
  for (const EdgeForms& sums : sums_) all += sums;
  forms.front() = {all.ll, all.mm, all.xl, all.xm};
}

// Only constrained nodes are asked for, a few: one by one, not by a sweep over the mesh.
std::array<double, 2> ParallelEdgeBody::force_of(const double* rows, std::size_t node) const {
  const auto run = std::upper_bound(
      form_.runs.begin(), form_.runs.end(), node,
      [](std::size_t i, const EdgeForm::Run& r) { return i < static_cast<std::size_t>(r.last); });
  const EdgeForm::Edges edges = run->edges_of(static_cast<std::int64_t>(node));
  const double* own = rows + 4 * node;
  std::array<double, 2> f{};
  for (std::int32_t k = 0; k < run->valence; ++k) {
    const auto edge = static_cast<std::size_t>(edges.edge + k * edges.stride);
    const double* other = rows + form_.offset[edge];
    const std::array<double, 4> level = form_.full_level(edge);
    const double mixed = form_.mixed[edge];
    double d[4];
    for (std::size_t c = 0; c < 4; ++c) d[c] = other[c] - own[c];
    f[0] += level[0] * d[0] + level[2] * d[2] + mixed * (d[1] + d[3]);
    f[1] += level[1] * d[1] + level[3] * d[3] + mixed * (d[0] + d[2]);
  }
  const auto by_node = [](const EdgeForm::Corner& c, std::size_t i) {
    return static_cast<std::size_t>(c.node) < i;
  };
  for (auto c = std::lower_bound(form_.corners.begin(), form_.corners.end(), node, by_node);
       c != form_.corners.end() && static_cast<std::size_t>(c->node) == node; ++c) {
    const double* next = rows + 4 * static_cast<std::size_t>(c->next);
    const double* previous = rows + 4 * static_cast<std::size_t>(c->previous);
    f[0] += form_.corner_factor * ((next[1] - previous[1]) - (next[3] - previous[3]));
    f[1] -= form_.corner_factor * ((next[0] - previous[0]) - (next[2] - previous[2]));
  }
  return f;
}

}  // namespace rheo
