// Named rheological models and the material that each comes to.
//
// A model is a circuit of springs [Pa] and dashpots [Pa s], each with a number for lambda and one for mu.
// Springs and dashpots that are parallel or form Maxwell branches go over as they are; models with elements
// in series become the parallel material of the same relaxation function.
//
//   elastic              elastic
//   plastic              viscous: what is deformed stays deformed when the load goes
//   kelvin_voigt         elastic | viscous
//   maxwell              ela - vis
//   zener                (ela - vis) | elastic
//   burgers_equivalent   ela_1 - vis_1 - (ela_2 | vis_2)      as two Maxwell branches, below
//   five_element         (ela_1 - vis_1) | (ela_2 - vis_2) | viscous
//
// with "-" for in series and "|" for parallel. Burgers, by lambda and mu each, with a = vis_1 / ela_1,
// b = vis_2 / ela_2, c = vis_1 / ela_2 and A = sqrt((a + b + c)^2 - 4 a b):
//
//   r(t) = w_1 exp(-r_1 t) + w_2 exp(-r_2 t),   r_1 = 2 / (a + b + c + A),   r_2 = (a + b + c + A) / (2 a b)
//   w_1 = vis_1 (1 - b r_1) / A,   w_2 = vis_1 (b r_2 - 1) / A,   w_1 + w_2 = ela_1
//
// Source   elastic, plastic: Hirai and Tomokuni, Figure 1, (d) for plastic; Kelvin-Voigt, Maxwell, Burgers
// and
//          the closed form: Findley, Lai and Onaran, Creep and Relaxation of Nonlinear Viscoelastic
//          Materials, 1976, chapter 5; Zener, Elasticity and Anelasticity of Metals, 1948; five_element: Wang
//          and Hirai, Finite Element Modeling and Physical Property Estimation of Rheological Food Objects,
//          Journal of Food Research 1(1), 2012 (without their second moduli for unloading)
// Units    springs [Pa], dashpots [Pa s]
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rheo/material.hpp"

namespace rheo {

struct PresetElement {
  enum class Kind {
    spring,           // >= 0
    dashpot,          // > 0; infinite: locked
    finite_dashpot,   // > 0
    parallel_dashpot  // >= 0
  };
  std::string name;
  Kind kind = Kind::spring;
};

struct Preset {
  std::string name;
  std::string circuit;  // as above
  std::string source;
  std::vector<PresetElement> elements;
  // Fills the parts of a material from values in the order of `elements`.
  void (*expand)(std::span<const Moduli> values, Material& material) = nullptr;
};

const std::vector<Preset>& material_presets();

// Of that name; nullptr where there is none.
const Preset* find_preset(std::string name);  // "-" counts as "_"

// `material` with its branches, elastic and viscous parts replaced by the preset's. Needs as many values as
// the preset has elements, each as its kind says.
Material expanded(const Preset& preset, std::span<const Moduli> values, Material material = {});

}  // namespace rheo
