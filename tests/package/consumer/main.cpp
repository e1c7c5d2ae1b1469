#include <cstdio>
#include <rheo/rheo.hpp>

int main() {
  rheo::Scene scene;
  scene.mesh = rheo::rectangle({1.0, 0.25}, 5, 2);
  scene.material = {.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2};
  scene.fixes.push_back({.nodes = rheo::nodes_of(scene.mesh.edge_groups.at("left"))});
  scene.tractions.push_back(
      {.edges = scene.mesh.edge_groups.at("right"), .keys = {{.p = {10, 0}}}, .window = {.until = 1.0}});
  scene.time.duration = 5.0;
  rheo::Simulation simulation(scene);
  for (int k = 0; k <= 5; ++k) {
    if (simulation.advance(k)) return 1;  // diverged
    std::printf("%g s: tip at %.6f m\n", simulation.time(), 1.0 + simulation.u()[2 * 4]);
  }
}
