#include "run_checkpoint.hpp"

#include <fmt/format.h>

#include <utility>

#include "failure.hpp"
#include "run_identity.hpp"

namespace app {

RunCheckpoint::RunCheckpoint(std::filesystem::path file, double interval, std::string identity)
    : file_(std::move(file)),
      interval_(interval),
      identity_(std::move(identity)),
      last_(std::chrono::steady_clock::now()) {}

bool RunCheckpoint::is_due() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - last_;
  return passed.count() >= interval_;
}

void RunCheckpoint::write(rheo::Simulation& simulation, Records& records, const RunProgress& progress,
                          const Seconds& seconds) {
  rheo::ByteWriter companion;
  companion.put_text(identity_);
  companion.put(progress.outputs);
  companion.put(static_cast<std::uint64_t>(progress.simulated ? 1 : 0));
  companion.put(seconds);
  records.put_aside(companion);
  rheo::write_checkpoint(file_, simulation, companion.bytes());
  exists_ = true;
  // From its end: a slow disk is not written to all the time.
  last_ = std::chrono::steady_clock::now();
}

void RunCheckpoint::remove() {
  std::error_code ignored;
  if (exists_) std::filesystem::remove(file_, ignored);
  exists_ = false;
}

CutRun::CutRun(rheo::Checkpoint checkpoint)
    : checkpoint_(std::move(checkpoint)),
      name_(checkpoint_.file.string()),
      in_(checkpoint_.companion, name_),
      identity_(in_.get_text()) {}

void CutRun::require_same(const std::string& identity) const {
  if (const auto difference = first_difference(identity_, identity))
    throw Failure(ExitCode::usage,
                  fmt::format("{}: the cut run had {}: name what it had, or begin anew with --force", name_,
                              *difference));
}

RunProgress CutRun::take_up(rheo::Simulation& simulation, Records& records, Seconds& seconds) {
  rheo::go_on(simulation, checkpoint_);
  RunProgress progress;
  progress.outputs = in_.get<std::int64_t>();
  progress.simulated = in_.get<std::uint64_t>() != 0;
  const auto before = in_.get<Seconds>();
  for (double Seconds::*phase : {&Seconds::read, &Seconds::build, &Seconds::simulate, &Seconds::draw,
                                 &Seconds::encode, &Seconds::write})
    seconds.*phase += before.*phase;
  records.take_up(in_);
  in_.expect_end();
  return progress;
}

}  // namespace app
