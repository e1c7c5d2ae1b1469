// Parts of the program that a whole run cannot reach or cannot show.
#include <gmock/gmock.h>

#include <numeric>

#include "frame_outputs.hpp"
#include "frame_store.hpp"
#include "nearest.hpp"
#include "program.hpp"
#include "recorder.hpp"
#include "rheo/shapes.hpp"
#include "sheet_frames.hpp"

namespace app_tests {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::SizeIs;

TEST(SheetFrames, AreEquallySpacedWhereTheRunAllowsIt) {
  // 5 s at 60 a second: every half second, the release at 1 s among them.
  EXPECT_THAT(app::sheet_frames(301, 60.0, {1.0}, std::nullopt, 99),
              ElementsAre(0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300));
}

TEST(SheetFrames, IncludeFirstLastAndEventsOfAnyRun) {
  for (const std::int64_t outputs : {9, 10, 47, 101, 302, 1234}) {
    const double rate = 30.0;
    const std::int64_t event = outputs / 3;
    const auto frames =
        app::sheet_frames(outputs, rate, {static_cast<double>(event) / rate}, std::nullopt, 99);
    EXPECT_GE(frames.size(), 8u);
    EXPECT_LE(frames.size(), 12u);
    EXPECT_EQ(frames.front(), 0);
    EXPECT_EQ(frames.back(), outputs - 1);
    EXPECT_THAT(frames, Contains(event));
    for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_LT(frames[i - 1], frames[i]);
  }
}

TEST(SheetFrames, AreAllOutputsOfAShortRunAndAsManyAsWanted) {
  EXPECT_THAT(app::sheet_frames(3, 60.0, {}, std::nullopt, 99), ElementsAre(0, 1, 2));
  EXPECT_THAT(app::sheet_frames(1, 60.0, {}, 5, 99), ElementsAre(0));
  EXPECT_THAT(app::sheet_frames(301, 60.0, {}, 4, 99), ElementsAre(0, 100, 200, 300));
}

TEST(SheetFrames, OfTimesThatNoOutputHasAreTold) {
  rheo::Scene scene;
  scene.time.duration = 1.25;
  scene.time.frame_rate = 10;
  scene.picture.sheet = {0.0, 0.26, 0.5, 1.2};
  EXPECT_THAT(app::notes_on_sheet_times(scene, 13),
              ElementsAre("the sheet shows t = 0.3 s for 0.26 s, which is between outputs"));
  scene.picture.sheet = {0.0, 0.3, 0.33, 1.2};
  EXPECT_THAT(app::notes_on_sheet_times(scene, 12),  // as where a run diverges
              ElementsAre("the sheet shows 0.3 s once: the output nearest to t = 0.33 s too",
                          "no shape of the sheet is of t = 1.2 s: outputs end at 1.1 s"));
  scene.time.frame_rate = 60;
  scene.picture.sheet = {0.0166667, 0.5};
  EXPECT_TRUE(app::notes_on_sheet_times(scene, 75).empty());
}

TEST(SheetFrames, AreFewerInSmallPicturesUnlessANumberIsWanted) {
  const auto few = app::sheet_frames(301, 60.0, {1.0}, std::nullopt, 6);
  EXPECT_THAT(few, ElementsAre(0, 60, 120, 180, 240, 300));
  EXPECT_THAT(app::sheet_frames(301, 60.0, {}, std::nullopt, 0), ElementsAre(0, 300));
  EXPECT_THAT(app::sheet_frames(301, 60.0, {}, 10, 3), SizeIs(10));
}

TEST(FrameOutputs, AreTheFirstEveryNthAndTheLast) {
  EXPECT_EQ(app::frame_count(0, 3), 0);
  for (const int every : {1, 2, 3, 7, 8, 9, 1000}) {
    for (const std::int64_t outputs : {1, 2, 8, 9, 10}) {
      std::vector<std::int64_t> expected, found;
      for (std::int64_t k = 0; k < outputs; ++k)
        if (k % every == 0 || k == outputs - 1) expected.push_back(k);
      for (std::int64_t i = 0; i < app::frame_count(outputs, every); ++i)
        found.push_back(app::frame_output(i, outputs, every));
      EXPECT_EQ(found, expected) << outputs << " outputs, every " << every;
    }
  }
}

TEST(FrameOutputs, AreKeptWithThoseOfTheSheet) {
  const app::KeptOutputs kept(12, 4, {5, 8, 2, 11, 5});
  std::vector<std::int64_t> found;
  for (std::int64_t k = 0; k < 12; ++k) {
    EXPECT_EQ(kept.below(k), static_cast<std::int64_t>(found.size())) << k;
    if (kept.has(k)) found.push_back(k);
  }
  EXPECT_THAT(found, ElementsAre(0, 2, 4, 5, 8, 11));
  EXPECT_EQ(kept.count(), 6);
}

TEST(EventTimes, AreTheInnerEndsOfWindowsAndKeys) {
  rheo::Scene scene;
  scene.time.duration = 4.0;
  scene.fixes.resize(1);
  scene.fixes[0].window = {0.0, 3.0};
  scene.tractions.resize(1);
  scene.tractions[0].window = {1.0, rheo::forever};
  scene.moves.resize(1);
  scene.moves[0].window = {1.0, 9.0};
  for (const double t : {0.5, 2.0, 5.0}) scene.moves[0].keys.push_back({t, {}, {}});
  EXPECT_THAT(app::event_times(scene), ElementsAre(0.5, 1.0, 2.0, 3.0));
}

TEST(Nearest, FindsSlipsOfThePenAndLeavesStrangersAlone) {
  const std::vector<std::string> known{"run", "render", "check"};
  EXPECT_EQ(app::nearest("rnder", known), "render");
  EXPECT_EQ(app::nearest("chekc", known), "check");
  EXPECT_EQ(app::nearest("simulate", known), "");
}

class FrameStore : public ProgramTest {};

TEST_F(FrameStore, GivesRecordsBackFromMemoryAndFromAFileThatGoesWithIt) {
  for (const std::int64_t memory_limit : {std::int64_t{1} << 20, std::int64_t{0}}) {
    app::FrameStore store(folder(), 100, 20, memory_limit);
    std::vector<float> record(100);
    for (int k = 0; k < 20; ++k) {
      std::iota(record.begin(), record.end(), static_cast<float>(1000 * k));
      store.append(record);
    }
    EXPECT_EQ(store.count(), 20);
    for (const int k : {19, 0, 7}) {
      store.read(k, record);
      EXPECT_EQ(record.front(), static_cast<float>(1000 * k));
      EXPECT_EQ(record.back(), static_cast<float>(1000 * k + 99));
    }
    EXPECT_THAT(files(), SizeIs(memory_limit > 0 ? 0 : 1));
  }
  EXPECT_THAT(files(), SizeIs(0));
}

TEST_F(FrameStore, SaysBeforehandThatTheDiskIsTooSmall) {
  EXPECT_THROW(app::FrameStore(folder(), std::size_t{1} << 40, std::int64_t{1} << 40), std::exception);
}

class Recorder : public ProgramTest {
 protected:
  static rheo::Scene scene() {
    rheo::Scene scene;
    scene.mesh = rheo::rectangle({1.0, 0.25}, 5, 2);
    scene.material = {.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2};
    scene.fixes.emplace_back().nodes = rheo::nodes_of(scene.mesh.edge_groups.at("left"));
    scene.body_acceleration = {1.0, 0.0};
    scene.time.duration = 1.0;
    scene.time.frame_rate = 20.0;
    return scene;
  }
  using Drawn = std::pair<std::vector<double>, std::vector<double>>;  // positions, scalars
  static Drawn read(const app::Recorder& recorder, std::int64_t k) {
    Drawn drawn;
    recorder.read(k, drawn.first, drawn.second);
    return drawn;
  }
};

// A run that diverges ends at an output that was not to be kept, and may have been cut at just that one.
TEST_F(Recorder, KeepsTheLastOutputWhereverARunEnds) {
  rheo::Simulation simulation(scene());
  app::Recorder all(scene(), folder() / "all", app::KeptOutputs(21, 1, {}));
  app::Recorder some(scene(), folder(), app::KeptOutputs(21, 3, {5}));
  constexpr std::int64_t outputs = 9;
  for (std::int64_t k = 0; k < outputs; ++k) {
    ASSERT_FALSE(simulation.advance(rheo::output_time(simulation.scene().time, k)));
    all.record(simulation, k);
    some.record(simulation, k);
  }
  rheo::ByteWriter bytes;
  some.put(bytes);
  some.end();
  const std::string kept = bytes.take();
  rheo::ByteReader in(kept, "kept");
  app::Recorder later(scene(), folder(), app::KeptOutputs(21, 3, {5}));
  later.get(in);
  in.expect_end();
  later.end();
  for (const app::Recorder* recorder : {&some, &later}) {
    EXPECT_EQ(recorder->count(), outputs);
    EXPECT_EQ(recorder->bounds(), all.bounds()) << "of all outputs";
    EXPECT_EQ(recorder->scalar_range(), all.scalar_range());
    for (const std::int64_t k : {0, 3, 5, 6, 8}) {
      EXPECT_EQ(read(*recorder, k), read(all, k)) << k;
      EXPECT_EQ(recorder->nearest_kept(k), k);
    }
    EXPECT_EQ(recorder->nearest_kept(1), 0);
    EXPECT_EQ(recorder->nearest_kept(2), 3);
    EXPECT_EQ(recorder->nearest_kept(7), 6);
  }
}

}  // namespace
}  // namespace app_tests
