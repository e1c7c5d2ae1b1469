#include "check_plots.hpp"

#include "bench_picture.hpp"
#include "material_curves.hpp"
#include "material_picture.hpp"
#include "rheo/io/atomic_file.hpp"
#include "run_notes.hpp"
#include "run_report.hpp"

namespace app {
namespace {

void write_table(const std::string& name, const std::string& text, OutputFolder& folder) {
  rheo::AtomicFile file(folder.file(name));
  file.write(text);
  file.commit();
  folder.made(name);
}

}  // namespace

std::vector<std::string> write_plots(const rheo::Scene& scene, const Options& options, OutputFolder& folder) {
  CheckReport report;
  report.scene_text = file_text(options.scene);
  for (const std::string& file : scene.files) report.read_files.push_back(fingerprint(file));
  report.notes = run_notes(scene);
  std::vector<std::string> notes;
  folder.clear();
  const MaterialCurves curves = curves_of(scene);
  write_table("relaxation.csv", relaxation_csv(curves), folder);
  write_table("moduli.csv", moduli_csv(curves), folder);
  const std::string no_drawing = no_picture(scene.picture, options);
  if (no_drawing.empty())
    notes = draw_material(scene, curves, options, folder);
  else
    notes.push_back("no picture: " + no_drawing);
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  folder.made("run.json");
  report.files = folder.all_made();
  write_check_report(folder.file("run.json"), options, scene, report);
  return notes;
}

}  // namespace app
