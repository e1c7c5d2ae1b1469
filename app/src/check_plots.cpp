#include "check_plots.hpp"

#include <fmt/format.h>

#include "bench_picture.hpp"
#include "material_curves.hpp"
#include "material_picture.hpp"
#include "rheo/io/atomic_file.hpp"
#include "run_notes.hpp"
#include "run_report.hpp"
#include "scene_parts.hpp"

namespace app {
namespace {

void write_table(const std::string& name, const std::string& text, OutputFolder& folder) {
  rheo::AtomicFile file(folder.file(name));
  file.write(text);
  file.commit();
  folder.made(name);
}

// The scene with one of its materials only, and without a mesh.
rheo::Scene scene_of(const MaterialPart& part, const rheo::Scene& scene, bool is_one_of_several) {
  rheo::Scene one;
  one.title = scene.title;
  if (is_one_of_several) one.title += (one.title.empty() ? "" : ", ") + part.name;
  one.material = *part.material;
  one.origin = *part.origin;
  one.time = scene.time;
  one.picture = scene.picture;
  return one;
}

}  // namespace

std::vector<std::string> write_plots(const rheo::Scene& scene, const Options& options, OutputFolder& folder) {
  CheckReport report;
  report.scene_text = file_text(options.scene);
  for (const std::string& file : scene.files) report.read_files.push_back(fingerprint(file));
  report.notes = run_notes(scene);
  std::vector<std::string> notes;
  folder.clear();
  const std::string no_drawing = no_picture(scene.picture, options);
  if (!no_drawing.empty()) notes.push_back("no picture: " + no_drawing);
  const std::vector<MaterialPart> materials = materials_of(scene);
  for (const MaterialPart& part : materials) {
    const rheo::Scene one = scene_of(part, scene, materials.size() > 1);
    const std::string ending = part.number == 0 ? "" : fmt::format("_{}", part.number);
    const MaterialCurves curves = curves_of(one);
    write_table("relaxation" + ending + ".csv", relaxation_csv(curves), folder);
    write_table("moduli" + ending + ".csv", moduli_csv(curves), folder);
    if (!no_drawing.empty()) continue;
    for (const std::string& note : draw_material(one, curves, ending, options, folder))
      notes.push_back(materials.size() > 1 ? fmt::format("{}: {}", part.name, note) : note);
  }
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  folder.made("run.json");
  report.files = folder.all_made();
  write_check_report(folder.file("run.json"), options, scene, report);
  return notes;
}

}  // namespace app
