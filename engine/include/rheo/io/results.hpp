// Result files: state.csv and ParaView's .vtu/.pvd.
//
// state.csv: node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y with 17 significant digits; of several
// bodies a last column, body, their number from 1.
// .vtu: points in the reference position, point data u, v, w_lambda, w_mu (3 components), cell data strain
// and stress (xx, yy, xy) [Pa], body (from 1) and region (the material's number from 0).
//
// Errors   Error::Kind::file
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

struct StateView {  // all n x 2
  std::span<const double> u, v, w_lambda, w_mu;
  std::span<const double> pull_lambda = {}, pull_mu = {};  // what the stress comes from; empty: w
  std::span<const double> stress = {};                     // m x 3, where it is known; empty: from those
};

// What a mesh consists of; empty: one body, one material.
struct PartsView {
  std::span<const BodyPart> bodies;
  std::span<const std::int32_t> region_of_triangle;
};

void write_state_csv(const std::filesystem::path& file, const Mesh& mesh, const StateView& state,
                     const PartsView& parts = {});
void write_vtu(const std::filesystem::path& file, const Mesh& mesh, const StateView& state,
               const PartsView& parts = {});
// The series' index: one line per (time, .vtu file name).
struct VtuEntry {
  double t = 0.0;
  std::string name;
};
void write_pvd(const std::filesystem::path& file, const std::vector<VtuEntry>& entries);

}  // namespace rheo
