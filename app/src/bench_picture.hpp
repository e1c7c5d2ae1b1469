// The picture of `rheo bench`: seconds against error, a curve an integrator, both axes logarithmic.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench_runs.hpp"
#include "command_line.hpp"

namespace app {

// Why this machine or this build cannot draw; empty where it can.
std::string no_picture(const rheo::PictureSettings& picture, const Options& options);

// Errors: std::runtime_error of the renderer, a file's included.
void draw_bench(const std::filesystem::path& file, const rheo::Scene& scene, const std::vector<Row>& rows,
                const Options& options);

}  // namespace app
