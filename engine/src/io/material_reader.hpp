// The table [material] of a scene file.
//
// The branches and parts are given in one of these ways:
//
//   lambda_ela, mu_ela, lambda_vis, mu_vis    one Maxwell branch; and, or instead,
//   [material.elastic], [material.viscous]    lambda, mu
//   [[material.maxwell]]                      as the four keys, or time [s] for the viscosities
//   preset = "zener"                          with lambda_X, mu_X of each element X (material_presets.hpp)
//   relaxation = "file.csv"                   time [s], modulus [Pa]
//   frequency = "file.csv"                    frequency [Hz], storage, loss [Pa]
//
// Where lambda_X and mu_X stand, young_X with poisson can stand, and young for lambda and mu; plane tells
// which of the flat models is meant. poisson in [material] serves all of its tables; one of them may have its
// own, under plane strain. The data are of Young's modulus or, with modulus = "shear", of mu; they are fitted
// by a Prony series (prony_fit.hpp), with one Poisson's ratio for all of it.
//
// Errors   Error::Kind::input, "file:line: [material] key = value: what is allowed"; Error::Kind::file for
// data
//          that cannot be read
#pragma once

#include <string>
#include <vector>

#include "io/allowance.hpp"
#include "io/toml_tree.hpp"
#include "rheo/material.hpp"
#include "rheo/material_origin.hpp"

namespace rheo {

struct MaterialReading {
  Material material;
  MaterialOrigin origin;
  std::vector<std::string> files;  // that were opened
  std::vector<std::string> notes;  // for the user
};

// `file` stands for the scene in messages, `owner` is what the table's name begins with ("body.").
MaterialReading read_material(const TomlValue& table, const std::string& file, Allowance& allowance,
                              const std::string& owner = {});

}  // namespace rheo
