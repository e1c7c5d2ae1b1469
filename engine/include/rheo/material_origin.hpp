// How a scene's material was given, where that was not by lambda and mu: for reports and pictures. The engine
// computes with Material alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rheo/elastic_constants.hpp"
#include "rheo/prony_fit.hpp"

namespace rheo {

// Young's modulus [Pa], or the extensional viscosity [Pa s], that became lambda and mu.
struct MaterialConversion {
  std::string name;  // "[material] young_ela", "[material.elastic] young"
  const char* unit = "Pa";
  ElasticConstants given;
  Plane plane = Plane::strain;
  Moduli moduli;
};

enum class MeasuredModulus { young, shear };

// A measured modulus and the series fitted to it.
struct MeasuredMaterial {
  std::string file;
  std::vector<RelaxationPoint> relaxation;  // one of the two is empty
  std::vector<SweepPoint> sweep;
  MeasuredModulus modulus = MeasuredModulus::young;
  double poisson = 0.0;  // of all parts
  Plane plane = Plane::strain;
  FitWeights weights = FitWeights::relative;
  PronyFit fit;
};

struct MaterialOrigin {
  std::string preset;
  std::vector<MaterialConversion> conversions;
  std::optional<MeasuredMaterial> measured;
};

}  // namespace rheo
