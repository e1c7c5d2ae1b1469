#include "rheo/fingerprint.hpp"

namespace rheo {
namespace {

void add(Fingerprint& f, const Vec2& v) {
  f.add(v.x);
  f.add(v.y);
}

void add(Fingerprint& f, const Moduli& moduli) {
  f.add(moduli.lambda);
  f.add(moduli.mu);
}

void add(Fingerprint& f, const Window& window) {
  f.add(window.from);
  f.add(window.until);
}

// Lists begin with their length: what ends one and begins the next is never taken for the other.
template <class List, class Add>
void add_list(Fingerprint& f, const List& list, const Add& add_one) {
  f.add(static_cast<std::uint64_t>(list.size()));
  for (const auto& each : list) add_one(each);
}

void add(Fingerprint& f, const Material& material) {
  f.add(static_cast<std::uint64_t>(material.branch_count()));
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch branch = material.branch(k);
    for (const double x : {branch.lambda_ela, branch.mu_ela, branch.lambda_vis, branch.mu_vis}) f.add(x);
  }
  add(f, material.elastic);
  add(f, material.viscous);
  f.add(material.density);
  f.add(static_cast<int>(material.mass));
}

void add(Fingerprint& f, const Mesh& mesh) {
  add_list(f, mesh.points, [&](const Vec2& point) { add(f, point); });
  add_list(f, mesh.triangles, [&](const Triangle& triangle) {
    for (const int node : triangle) f.add(node);
  });
  f.add(mesh.thickness);
  add_list(f, mesh.thickness_of_node, [&](double thickness) { f.add(thickness); });
}

void add(Fingerprint& f, const Move& move) {
  add_list(f, move.nodes, [&](int node) { f.add(node); });
  f.add(static_cast<int>(move.axis));
  add(f, move.window);
  f.add(static_cast<int>(move.profile));
  add_list(f, move.keys, [&](const MoveKey& key) {
    f.add(key.t);
    add(f, key.u);
    add(f, key.v);
  });
}

void add(Fingerprint& f, const Traction& traction) {
  add_list(f, traction.edges, [&](const Edge& edge) {
    f.add(edge[0]);
    f.add(edge[1]);
  });
  add(f, traction.window);
  add_list(f, traction.keys, [&](const TractionKey& key) {
    f.add(key.t);
    add(f, key.p);
  });
}

void add(Fingerprint& f, const TimeSettings& time) {
  for (const double x : {time.duration, time.frame_rate, time.step, time.refinement, time.tolerance,
                         time.accuracy, time.baumgarte})
    f.add(x);
  f.add(static_cast<int>(time.integrator));
  f.add(static_cast<int>(time.constraints));
}

}  // namespace

std::uint64_t mesh_fingerprint(const Mesh& mesh) {
  Fingerprint f;
  add(f, mesh);
  return f.value();
}

std::uint64_t motion_fingerprint(const Scene& scene) {
  Fingerprint f;
  add(f, scene.mesh);
  add(f, scene.material);
  add_list(f, scene.regions, [&](const Region& region) { add(f, region.material); });
  add_list(f, scene.region_of_triangle, [&](std::int32_t region) { f.add(static_cast<int>(region)); });
  add(f, scene.body_acceleration);
  add_list(f, scene.fixes, [&](const Fix& fix) {
    add_list(f, fix.nodes, [&](int node) { f.add(node); });
    f.add(static_cast<int>(fix.axis));
    add(f, fix.window);
  });
  add_list(f, scene.moves, [&](const Move& move) { add(f, move); });
  add_list(f, scene.constraints, [&](const Constraint& constraint) {
    add_list(f, constraint.terms, [&](const ConstraintTerm& term) {
      f.add(term.node);
      f.add(static_cast<int>(term.axis));
      f.add(term.coefficient);
    });
    f.add(constraint.value);
  });
  add_list(f, scene.tractions, [&](const Traction& traction) { add(f, traction); });
  add(f, scene.time);
  return f.value();
}

}  // namespace rheo
