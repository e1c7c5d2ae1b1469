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

void ParallelEdgeBody::sweep_force(const SweepArrays& arrays, double h, std::size_t block) {
  const EdgeForm::Block& b = form_.blocks[block];
  edge_force_.sweep()(form_, inverse_mass(), SweepMaterial{}, h, arrays, b.first_run, b.last_run);
  edge_force_.subtract_boundary(h, inverse_mass(), arrays.x_p, arrays.out_v, corner_begin_[block],
                                corner_begin_[block + 1]);
}

// Sums over edges: x^T J_lambda w = - sum over edges of dx^T S dw, x^T J_mu w = - sum of dx^T (S + trace(S)
// I) dw, and the boundary's antisymmetric part (h / 4) rot(w_next - w_previous), + for lambda, - for mu.
void ParallelEdgeBody::forms_of(const double* w, std::size_t stride, const double* x,
                                std::span<Forms> forms) {
  const std::size_t mu = stride == 4 ? 2 : 0;
  team().chain(1, [&](std::size_t, std::size_t block) {
    Forms sums;
    for (std::int32_t r = form_.blocks[block].first_run; r < form_.blocks[block].last_run; ++r) {
      const EdgeForm::Run& run = form_.runs[r];
      for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.last); ++i) {
        const EdgeForm::Edges edges = run.edges_of(static_cast<std::int64_t>(i));
        auto e = static_cast<std::size_t>(edges.edge);
        for (std::int32_t k = 0; k < run.valence; ++k, e += static_cast<std::size_t>(edges.stride)) {
          const std::size_t j = form_.offset[e] / 4;
          if (j < i) continue;  // each edge once
          const std::array<double, 4> level = form_.full_level(e);
          const double mixed = form_.mixed[e];
          const double *wi = w + stride * i, *wj = w + stride * j;
          const double dx = x[2 * j] - x[2 * i], dy = x[2 * j + 1] - x[2 * i + 1];
          const double lx = wj[0] - wi[0], ly = wj[1] - wi[1];
          const double mx = wj[mu] - wi[mu], my = wj[mu + 1] - wi[mu + 1];
          const double slx = level[0] * lx + mixed * ly, sly = mixed * lx + level[1] * ly;
          const double smx = level[2] * mx + mixed * my, smy = mixed * mx + level[3] * my;
          sums.ll -= lx * slx + ly * sly;
          sums.xl -= dx * slx + dy * sly;
          sums.mm -= mx * smx + my * smy;
          sums.xm -= dx * smx + dy * smy;
        }
      }
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
  const double q = form_.corner_factor;
  for (const EdgeForm::Corner& c : form_.corners) {
    const double* next = w + stride * static_cast<std::size_t>(c.next);
    const double* previous = w + stride * static_cast<std::size_t>(c.previous);
    const double* wi = w + stride * static_cast<std::size_t>(c.node);
    const double* xi = x + 2 * static_cast<std::size_t>(c.node);
    const double lx = next[0] - previous[0], ly = next[1] - previous[1];
    const double mx = next[mu] - previous[mu], my = next[mu + 1] - previous[mu + 1];
    all.ll += q * (wi[0] * ly - wi[1] * lx);
    all.xl += q * (xi[0] * ly - xi[1] * lx);
    all.mm -= q * (wi[mu] * my - wi[mu + 1] * mx);
    all.xm -= q * (xi[0] * my - xi[1] * mx);
  }
  forms.front() = all;
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
