// A checkpoint that cannot be gone on from is refused, in one line that names it and says what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "io_error_of.hpp"
#include "rheo/fingerprint.hpp"
#include "rheo/io/checkpoint.hpp"
#include "support/event_scenes.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_text;
using ::testing::StartsWith;
using testing::write_text;

class CheckpointFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fresh_folder(::testing::UnitTest::GetInstance()->current_test_info()->name());
    file_ = folder_ / "checkpoint.rheo";
    Simulation simulation(scene_);
    ASSERT_FALSE(simulation.advance(0.3));
    write_checkpoint(file_, simulation, "kept beside");
    bytes_ = read_text(file_);
  }

  // Of a file with these bytes.
  std::string refusal(const std::string& bytes) const {
    const fs::path other = folder_ / "other.rheo";
    write_text(other, bytes);
    const std::string text = error_of([&] { read_checkpoint(other); });
    EXPECT_THAT(text, StartsWith(other.string()));
    return text;
  }

  std::string refusal_to_go_on(const Scene& scene, SimulationOptions options = {}) const {
    Simulation simulation(scene, options);
    const Checkpoint checkpoint = read_checkpoint(file_);
    return error_of([&] { go_on(simulation, checkpoint); });
  }

  Scene scene_ = test::moved(Mass::lumped, Profile::smooth);
  fs::path folder_, file_;
  std::string bytes_;
};

TEST_F(CheckpointFile, KeepsWhatWasGiven) {
  const Checkpoint checkpoint = read_checkpoint(file_);
  EXPECT_EQ(checkpoint.companion, "kept beside");
  EXPECT_EQ(checkpoint.snapshot.state.t, 0.3);
  EXPECT_EQ(checkpoint.snapshot.state.u.size(), 2 * scene_.mesh.points.size());
  EXPECT_FALSE(fs::exists(file_.string() + ".part"));
}

TEST_F(CheckpointFile, AnyFlippedByteIsNoticed) {
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    std::string other = bytes_;
    other[i] = static_cast<char>(other[i] ^ (1 << i % 8));
    const std::string text = refusal(other);
    if (i < 40) continue;  // the header has names of its own for what is wrong
    EXPECT_THAT(text, HasSubstr("is damaged")) << "byte " << i;
  }
}

TEST_F(CheckpointFile, AnyTruncationAndAnythingBehindItsEndIsNoticed) {
  for (std::size_t size = 1; size < bytes_.size(); ++size)
    EXPECT_THAT(refusal(bytes_.substr(0, size)), HasSubstr("truncated")) << size;
  EXPECT_THAT(refusal(bytes_ + "x"), HasSubstr("damaged"));
}

TEST_F(CheckpointFile, WhatIsNoneIsNamed) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("t,w_lambda_norm\n0,0\n"), HasSubstr("is not a checkpoint"));
  EXPECT_THAT(refusal(std::string(100000, '\0')), HasSubstr("is not a checkpoint"));
  EXPECT_THAT(error_of([&] { read_checkpoint(folder_); }, Error::Kind::file), HasSubstr("directory"));
  EXPECT_THAT(error_of([&] { read_checkpoint(folder_ / "none"); }, Error::Kind::file),
              AllOf(HasSubstr((folder_ / "none").string()), HasSubstr("No such file")));
}

TEST_F(CheckpointFile, AHugeFileCostsNothing) {
  const fs::path huge = folder_ / "huge.rheo";
  write_text(huge, bytes_);
  std::error_code no_room;
  fs::resize_file(huge, std::uintmax_t{1} << 40, no_room);
  if (no_room) GTEST_SKIP() << "no sparse files of this size here: " << no_room.message();
  EXPECT_THAT(error_of([&] { read_checkpoint(huge); }), HasSubstr("damaged"));
}

TEST_F(CheckpointFile, OtherVersionsAndByteOrdersAreNamed) {
  std::string other = bytes_;
  other[8] = 7;
  EXPECT_THAT(refusal(other),
              AllOf(HasSubstr("version 7"), HasSubstr("version " + std::to_string(checkpoint_version))));
  other = bytes_;
  std::swap(other[12], other[15]);
  std::swap(other[13], other[14]);
  EXPECT_THAT(refusal(other), HasSubstr("byte order"));
}

// With the right checksum: what a program of another version might write, or malice.
TEST_F(CheckpointFile, NonsenseWithARightChecksumEndsInALine) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    std::string other = bytes_.substr(0, bytes_.size() - 8);
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = 40 + random() % (other.size() - 40);
      other[at] = static_cast<char>(random());
    }
    const std::uint64_t sum = checksum(other);
    other.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    const fs::path file = folder_ / "nonsense.rheo";
    write_text(file, other);
    try {
      Simulation simulation(scene_);
      go_on(simulation, read_checkpoint(file));  // other numbers are as good as these
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST_F(CheckpointFile, AnotherScenesIsRefusedByName) {
  const auto with_file = [&](const char* text) { return AllOf(StartsWith(file_.string()), HasSubstr(text)); };
  Scene other = scene_;
  other.mesh = rectangle({2.0, 1.1}, 3, 2);
  EXPECT_THAT(refusal_to_go_on(other), with_file("another mesh"));
  {
    Simulation simulation(other);
    EXPECT_THAT(error_of([&] { begin_from(simulation, read_checkpoint(file_)); }), with_file("another mesh"));
  }
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene& s) { s.material.mu_vis *= 1.0 + 1e-15; },
      [](Scene& s) { s.moves[0].keys[1].u.y += 1e-12; },
      [](Scene& s) { s.moves[0].window.until = 0.7; },
      [](Scene& s) { s.fixes[0].axis = Axis::x; },
      [](Scene& s) { s.body_acceleration.y = -1.0; },
      [](Scene& s) { s.time.frame_rate = 61.0; },
      [](Scene& s) { s.time.step = 1e-4; },
      [](Scene& s) { s.time.integrator = IntegratorKind::exponential; }};
  for (const auto& change : changes) {
    other = scene_;
    change(other);
    EXPECT_THAT(refusal_to_go_on(other), with_file("another scene"));
  }
  EXPECT_THAT(refusal_to_go_on(scene_, {.kernel = Kernel::csr}), with_file("kernel"));
  EXPECT_THAT(refusal_to_go_on(scene_, {.energies = false}), with_file("energies"));
}

}  // namespace
}  // namespace rheo
