// The pictures of `rheo check --plot`: relaxation.png, moduli.png, fit.png, of a scene's second material
// relaxation_1.png and so on; all axes logarithmic.
//
// What has relaxed to less than a ten-thousandth of the largest value is not shown.
//
// Errors   std::runtime_error of the renderer, a file's included
#pragma once

#include "command_line.hpp"
#include "material_curves.hpp"
#include "output_folder.hpp"

namespace app {

// Needs a machine that can draw (no_picture in bench_picture.hpp). `ending`: of the names, "" or "_1". A
// picture of nothing is left out; returns notes for the user about that.
std::vector<std::string> draw_material(const rheo::Scene& scene, const MaterialCurves& curves,
                                       const std::string& ending, const Options& options,
                                       OutputFolder& folder);

}  // namespace app
