#include "rheo/material_presets.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "rheo/limits.hpp"

namespace rheo {
namespace {

using Values = std::span<const Moduli>;
using Kind = PresetElement::Kind;

MaxwellBranch branch_of(const Moduli& ela, const Moduli& vis) {
  return {ela.lambda, ela.mu, vis.lambda, vis.mu};
}

void set_first(Material& m, const MaxwellBranch& b) {
  m.lambda_ela = b.lambda_ela;
  m.mu_ela = b.mu_ela;
  m.lambda_vis = b.lambda_vis;
  m.mu_vis = b.mu_vis;
}

struct Branch {
  double ela = 0.0;
  double vis = std::numeric_limits<double>::infinity();
};

// A branch too weak for a number of a scene is off.
Branch usable(double ela, double rate) {
  if (!of_usable_size(ela) || !of_usable_size(ela / rate)) return {};
  return {ela, ela / rate};
}

// ela_1 and vis_1 in series with a Kelvin-Voigt element of ela_2 and vis_2.
std::array<Branch, 2> burgers(double ela_1, double vis_1, double ela_2, double vis_2) {
  if (ela_1 == 0.0) return {};  // no stress passes through
  if (ela_2 == 0.0) return {Branch{ela_1, 1.0 / (1.0 / vis_1 + 1.0 / vis_2)}, Branch{}};
  const double a = vis_1 / ela_1, b = vis_2 / ela_2, c = vis_1 / ela_2;
  // A without the difference of nearly equal squares.
  const double A = std::sqrt((a - b) * (a - b) + c * c + 2.0 * c * (a + b));
  const double sum = a + b + c + A;
  // x + A for A^2 = x^2 + rest, without cancellation where x < 0.
  const auto plus = [A](double x, double rest) { return x >= 0.0 ? x + A : rest / (A - x); };
  const double w_1 = vis_1 / A * plus(a - b + c, 4.0 * b * c) / sum;
  const double w_2 = vis_1 / A * plus(b + c - a, 4.0 * a * c) / (2.0 * a);
  return {usable(w_1, 2.0 / sum), usable(w_2, sum / (2.0 * a * b))};
}

void expand_burgers(Values v, Material& m) {
  const auto lambda = burgers(v[0].lambda, v[1].lambda, v[2].lambda, v[3].lambda);
  const auto mu = burgers(v[0].mu, v[1].mu, v[2].mu, v[3].mu);
  set_first(m, {lambda[0].ela, mu[0].ela, lambda[0].vis, mu[0].vis});
  m.more_branches = {{lambda[1].ela, mu[1].ela, lambda[1].vis, mu[1].vis}};
}

std::vector<Preset> make_presets() {
  const std::string findley =
      "Findley, Lai and Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, 1976";
  return {
      {"elastic",
       "elastic",
       "Hirai and Tomokuni, Dynamic Modeling of Rheological Deformation, Figure 1",
       {{"elastic", Kind::spring}},
       [](Values v, Material& m) { m.elastic = v[0]; }},
      {"plastic",
       "viscous",
       "Hirai and Tomokuni, Dynamic Modeling of Rheological Deformation, Figure 1 (d)",
       {{"viscous", Kind::parallel_dashpot}},
       [](Values v, Material& m) { m.viscous = v[0]; }},
      {"kelvin_voigt",
       "elastic | viscous",
       findley,
       {{"elastic", Kind::spring}, {"viscous", Kind::parallel_dashpot}},
       [](Values v, Material& m) {
         m.elastic = v[0];
         m.viscous = v[1];
       }},
      {"maxwell",
       "ela - vis",
       findley,
       {{"ela", Kind::spring}, {"vis", Kind::dashpot}},
       [](Values v, Material& m) { set_first(m, branch_of(v[0], v[1])); }},
      {"zener",
       "(ela - vis) | elastic",
       "Zener, Elasticity and Anelasticity of Metals, 1948",
       {{"ela", Kind::spring}, {"vis", Kind::dashpot}, {"elastic", Kind::spring}},
       [](Values v, Material& m) {
         set_first(m, branch_of(v[0], v[1]));
         m.elastic = v[2];
       }},
      {"burgers_equivalent",
       "ela_1 - vis_1 - (ela_2 | vis_2), as two Maxwell branches",
       findley,
       {{"ela_1", Kind::spring},
        {"vis_1", Kind::finite_dashpot},
        {"ela_2", Kind::spring},
        {"vis_2", Kind::finite_dashpot}},
       expand_burgers},
      {"five_element",
       "(ela_1 - vis_1) | (ela_2 - vis_2) | viscous",
       "Wang and Hirai, Journal of Food Research 1(1), 2012",
       {{"ela_1", Kind::spring},
        {"vis_1", Kind::dashpot},
        {"ela_2", Kind::spring},
        {"vis_2", Kind::dashpot},
        {"viscous", Kind::parallel_dashpot}},
       [](Values v, Material& m) {
         set_first(m, branch_of(v[0], v[1]));
         m.more_branches = {branch_of(v[2], v[3])};
         m.viscous = v[4];
       }},
  };
}

}  // namespace

const std::vector<Preset>& material_presets() {
  static const std::vector<Preset> presets = make_presets();
  return presets;
}

const Preset* find_preset(std::string name) {
  std::ranges::replace(name, '-', '_');
  const auto& presets = material_presets();
  const auto found =
      std::find_if(presets.begin(), presets.end(), [&](const Preset& p) { return p.name == name; });
  return found == presets.end() ? nullptr : &*found;
}

Material expanded(const Preset& preset, std::span<const Moduli> values, Material material) {
  assert(values.size() == preset.elements.size());
  set_first(material, {});
  material.more_branches.clear();
  material.elastic = material.viscous = {};
  preset.expand(values, material);
  return material;
}

}  // namespace rheo
