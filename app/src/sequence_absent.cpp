// Stands in for sequence.cpp in a build without the renderer.
#include "failure.hpp"
#include "sequence.hpp"

namespace app {

struct Sequence::Impl {};

Sequence::Sequence(const rheo::PictureSettings&, const Options&) {
  throw Failure(
      ExitCode::usage,
      "render: this build of rheo has no renderer (it was configured with RHEO_RENDER=OFF): use rheo run, "
      "or build it with -DRHEO_RENDER=ON");
}

Sequence::~Sequence() = default;

std::string Sequence::description() const {
  return "none";
}

std::vector<std::int64_t> Sequence::sheet_outputs(const rheo::Scene&, std::int64_t) const {
  return {};
}

bool Sequence::draw(const rheo::Scene&, const Recorder&, const HistoryFile&, OutputFolder&, Progress&,
                    Seconds&, const DrawHooks&) {
  return true;
}

DrawCounters Sequence::counters() const {
  return {};
}

}  // namespace app
