#include "view/draft.hpp"

#include <algorithm>

namespace app::view {

Draft::Draft(const rheo::Scene& scene)
    : material(scene.material), acceleration(scene.body_acceleration), time(scene.time) {
  for (const rheo::Traction& traction : scene.tractions) tractions.push_back(traction.keys.front().p);
  for (const rheo::Region& region : scene.regions) regions.push_back(region.material);
}

rheo::Scene Draft::on(const rheo::Scene& scene) const {
  rheo::Scene edited = scene;
  edited.material = material;
  for (std::size_t i = 0; i < regions.size() && i < edited.regions.size(); ++i)
    edited.regions[i].material = regions[i];
  edited.body_acceleration = acceleration;
  if (static_cast<std::size_t>(edited.picture.branch) > rheo::most_branches(edited))
    edited.picture.branch = 0;
  edited.time = time;
  edited.time.where.clear();
  for (std::size_t i = 0; i < tractions.size() && i < edited.tractions.size(); ++i)
    if (edited.tractions[i].keys.size() == 1) edited.tractions[i].keys.front().p = tractions[i];
  return edited;
}

}  // namespace app::view
