#include "records.hpp"

#include "rheo/simulation.hpp"

namespace app {

Records::Records(const rheo::Scene& scene, OutputFolder& folder, const Options& options,
                 const std::vector<std::int64_t>& sheet, Progress& progress)
    : scene_(scene), folder_(folder), watch_(progress) {
  if (options.vtu) vtu_.emplace(folder);
  if (options.command == Command::render)
    recorder_.emplace(scene, folder.path(),
                      KeptOutputs(rheo::output_count(scene.time), scene.picture.every, sheet));
}

void Records::begin() {
  history_.emplace(folder_.file("history.csv"), scene_);
}

void Records::take_up(rheo::ByteReader& in) {
  history_.emplace(folder_.file("history.csv"), in.get<GrowingFile::Mark>());
  watch_.get(in);
  if (vtu_) vtu_->take_up(history_->times());
  if (recorder_) recorder_->get(in);
}

void Records::record(rheo::Simulation& simulation, std::int64_t k, Seconds& seconds) {
  const Timed timed(seconds.write);
  history_->record(simulation, k);
  watch_.record(simulation, k);
  if (vtu_) vtu_->record(simulation, k);
  if (recorder_) recorder_->record(simulation, k);
}

void Records::put_aside(rheo::ByteWriter& out) {
  out.put(history_->keep());
  watch_.put(out);
  if (recorder_) recorder_->put(out);
}

void Records::discard() {
  if (recorder_) recorder_->discard();
}

void Records::commit() {
  history_->commit();
  folder_.made("history.csv");
  if (vtu_) vtu_->finish();
  if (recorder_) recorder_->end();
}

}  // namespace app
