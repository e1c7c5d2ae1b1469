// The panel of materials: every branch, the elastic and the viscous part, of every material of the mesh.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr double usual_time = 1.0;         // [s] of a branch that begins to relax, where nothing says another
constexpr double usual_damping = 0.01;     // [s]: viscous part over moduli
constexpr double next_branch_share = 0.1;  // of the last one's relaxation time

double first_usable(double a, double b) {
  if (a > 0.0 && std::isfinite(a)) return a;
  return b > 0.0 && std::isfinite(b) ? b : 1.0;
}

// The last branch again, a decade quicker.
rheo::MaxwellBranch another(const rheo::Material& m) {
  rheo::MaxwellBranch branch = m.branch(m.branch_count() - 1);
  branch.lambda_vis = next_branch_share * first_usable(branch.lambda_vis, branch.lambda_ela * usual_time);
  branch.mu_vis = next_branch_share * first_usable(branch.mu_vis, branch.mu_ela * usual_time);
  return branch;
}

}  // namespace

void Ui::draw_material_section() {
  if (!widgets_.begin_section("Material", Widgets::At::first_open)) return;
  if (draft_->regions.empty()) draw_material(draft_->material, base_->material);
  // Of several each has its name.
  const std::size_t count = std::min(draft_->regions.size(), base_->regions.size()) + 1;
  for (std::size_t i = 0; i < count && count > 1; ++i) {
    const std::string& name = i == 0 ? base_->material_name : base_->regions[i - 1].name;
    const std::string title =
        name.empty() ? fmt::format("material {}", i + 1) : fmt::format("material {}, {}", i + 1, name);
    if (!widgets_.begin_tree(title.c_str(), i == 0 ? Widgets::At::first_open : Widgets::At::first_closed))
      continue;
    draw_material(i == 0 ? draft_->material : draft_->regions[i - 1], rheo::material_of(*base_, i));
    widgets_.end_tree();
  }
  widgets_.end_section();
}

// Three decades to either side of the scene's own value; from 0 where that is 0.
void Ui::modulus(const char* name, double* value, double base, double usual, const char* unit) {
  const std::string format = fmt::format("%.6g {}", unit);
  const double around = first_usable(base, usual);
  if (widgets_.slider(name, value, base > 0.0 ? around * 1e-3 : 0.0, around * 1e3, format.c_str())) edit();
}

void Ui::viscosity(const char* name, double* value, double base, double ela) {
  if (std::isinf(*value))
    Widgets::idle_slider(name, "never relaxes");
  else
    modulus(name, value, base, ela * usual_time, "Pa s");
}

void Ui::draw_branch(BranchValues b, const rheo::MaxwellBranch& base) {
  modulus("lambda_ela", b.lambda_ela, base.lambda_ela, base.mu_ela, "Pa");
  modulus("mu_ela", b.mu_ela, base.mu_ela, base.lambda_ela, "Pa");
  viscosity("lambda_vis", b.lambda_vis, base.lambda_vis, base.lambda_ela);
  viscosity("mu_vis", b.mu_vis, base.mu_vis, base.mu_ela);
  const auto relaxes = [&](const char* name, double* vis, double base_vis, double ela) {
    bool yes = !std::isinf(*vis);
    if (!widgets_.checkbox(name, &yes)) return;
    *vis = yes ? first_usable(base_vis, ela * usual_time) : rheo::forever;
    edit();
  };
  relaxes("lambda relaxes", b.lambda_vis, base.lambda_vis, *b.lambda_ela);
  ImGui::SameLine();
  relaxes("mu relaxes", b.mu_vis, base.mu_vis, *b.mu_ela);
}

void Ui::draw_material(rheo::Material& m, const rheo::Material& base) {
  draw_branch({&m.lambda_ela, &m.mu_ela, &m.lambda_vis, &m.mu_vis}, base.branch(0));
  modulus("density", &m.density, base.density, 1000.0, "kg/m³");
  const rheo::Moduli stiff = base.instantaneous();
  modulus("elastic lambda", &m.elastic.lambda, base.elastic.lambda, stiff.lambda, "Pa");
  modulus("elastic mu", &m.elastic.mu, base.elastic.mu, stiff.mu, "Pa");
  modulus("viscous lambda", &m.viscous.lambda, base.viscous.lambda, usual_damping * stiff.lambda, "Pa s");
  modulus("viscous mu", &m.viscous.mu, base.viscous.mu, usual_damping * stiff.mu, "Pa s");
  for (std::size_t k = 0; k < m.more_branches.size(); ++k) {
    if (!widgets_.begin_tree(fmt::format("branch {}", k + 2).c_str())) continue;
    rheo::MaxwellBranch& b = m.more_branches[k];
    draw_branch({&b.lambda_ela, &b.mu_ela, &b.lambda_vis, &b.mu_vis},
                base.branch(k + 1 < base.branch_count() ? k + 1 : 0));
    widgets_.end_tree();
  }
  if (widgets_.button("Add a branch")) {
    m.more_branches.push_back(another(m));
    edit();
  }
  if (m.more_branches.empty()) return;
  ImGui::SameLine();
  if (widgets_.button("Remove the last")) {
    m.more_branches.pop_back();
    edit();
  }
}

}  // namespace app::view
