// Measured relaxation or frequency data as a material.
//
// A series of Young's modulus E or of mu becomes lambda and mu by one Poisson's ratio, term by term: E(t) =
// 2 (1 + nu) mu(t), and elastic_constants.hpp.
//
// Source   prony_fit.hpp
// Units    data: time [s], modulus [Pa], or frequency [Hz], storage, loss [Pa]
// Errors   Error::Kind::input "file:line: ..." or "file: ..."; Error::Kind::file where it cannot be read
#pragma once

#include <filesystem>
#include <string>

#include "memory_budget.hpp"
#include "rheo/material.hpp"
#include "rheo/material_origin.hpp"
#include "rheo/prony_fit.hpp"

namespace rheo {

enum class DataKind { relaxation, sweep };

// Reads the points into `measured` and fits them.
void fit_data(const std::filesystem::path& file, DataKind kind, const PronyOptions& options,
              MeasuredMaterial& measured, MemoryBudget& memory);

// Gives a material the branches and parts of the fit.
void set_series(const MeasuredMaterial& measured, Material& material);

// What a user should know about a poor fit; empty: nothing.
std::string doubt_about(const MeasuredMaterial& measured);

}  // namespace rheo
