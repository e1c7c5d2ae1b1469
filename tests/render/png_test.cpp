#include "render/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "decode.hpp"
#include "render/image.hpp"
#include "support.hpp"

namespace {

namespace fs = std::filesystem;
using render::Image;
using ::testing::HasSubstr;

Image patterned(int width, int height, bool transparent) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const int alpha = transparent ? i % 256 : 255;
    for (const int v : {i % 251, (i / 7) % 256, (i % 1000) * (i % 1000) % 253, alpha}) {
      image.rgba.push_back(static_cast<std::uint8_t>(v));
    }
  }
  return image;
}

// A new, empty folder.
fs::path fresh_folder(const std::string& name) {
  const fs::path folder = support::output_folder() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

TEST(Png, RoundTripKeepsEveryPixel) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {257, 63}, {640, 360}}) {
    for (const bool transparent : {false, true}) {
      const Image image = patterned(width, height, transparent);
      int channels = 0;
      const Image back = decode_png(render::encode_png(image), &channels);
      EXPECT_EQ(back.width, width);
      EXPECT_EQ(back.height, height);
      EXPECT_EQ(back.rgba, image.rgba);
      if (!transparent) {
        EXPECT_EQ(channels, 3) << "opaque pictures are stored without alpha";
      }
    }
  }
}

TEST(Png, EncodesTheSameBytesEveryTime) {
  const Image image = patterned(200, 100, false);
  EXPECT_EQ(render::encode_png(image), render::encode_png(image));
}

TEST(Png, RefusesAnImageThatContradictsItsSize) {
  Image image = patterned(4, 4, false);
  image.height = 5;
  EXPECT_THROW((void)render::encode_png(image), std::runtime_error);
  EXPECT_THROW((void)render::encode_png(Image{}), std::runtime_error);
}

TEST(Png, FileAppearsWholeAndReplacesAnOlderOne) {
  const fs::path folder = fresh_folder("png_whole");
  const fs::path file = folder / "a.png";
  render::write_png(file, patterned(50, 40, false));
  render::write_png(file, patterned(20, 10, false));
  EXPECT_EQ(read_png(file).rgba, patterned(20, 10, false).rgba);
  EXPECT_EQ(entries(folder), 1u) << "nothing is left aside";
}

TEST(Png, ErrorsNameThePathAndTheReason) {
  const fs::path file = support::output_folder() / "no_such_folder" / "a.png";
  try {
    render::write_png(file, patterned(2, 2, false));
    FAIL() << "written into a folder that does not exist";
  } catch (const render::FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr(file.string()));
    EXPECT_THAT(e.what(), HasSubstr("No such file or directory"));
  }
}

TEST(Png, AFailedRenameLeavesNothingBehind) {
  const fs::path folder = fresh_folder("png_rename");
  fs::create_directories(folder / "taken.png" / "inside");  // a folder cannot be replaced by a file
  EXPECT_THROW(render::write_png(folder / "taken.png", patterned(2, 2, false)), render::FileError);
  EXPECT_FALSE(fs::exists(folder / "taken.png.part"));
}

// A limit on the size of files stands for a full disk.
TEST(Png, AFullDiskLeavesNothingBehind) {
  const fs::path folder = fresh_folder("png_full");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = before;
  tight.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(render::write_png(folder / "a.png", patterned(300, 300, false)), render::FileError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(entries(folder), 0u);
}

TEST(PngSequence, WritesEveryFrameUnderItsName) {
  for (const int threads : {1, 2, 3}) {
    const fs::path folder = fresh_folder("png_sequence");
    render::PngSequence sequence(threads);
    for (int i = 0; i < 25; ++i) {
      Image image = sequence.recycle();
      image = patterned(30 + i, 20, false);
      sequence.submit(std::move(image), folder / (std::to_string(i) + ".png"));
    }
    sequence.finish();
    EXPECT_EQ(entries(folder), 25u);
    for (int i = 0; i < 25; ++i) {
      EXPECT_EQ(read_png(folder / (std::to_string(i) + ".png")).rgba, patterned(30 + i, 20, false).rgba);
    }
  }
}

TEST(PngSequence, MemoryOfFinishedFramesComesBack) {
  const fs::path folder = fresh_folder("png_recycle");
  render::PngSequence sequence(1);
  EXPECT_TRUE(sequence.recycle().rgba.empty());
  sequence.submit(patterned(64, 64, false), folder / "a.png");
  sequence.finish();
  EXPECT_EQ(sequence.recycle().rgba.size(), 64u * 64u * 4u);
}

TEST(PngSequence, TheFirstErrorReachesTheCaller) {
  const fs::path missing = support::output_folder() / "no_such_folder";
  render::PngSequence sequence(2);
  sequence.submit(patterned(8, 8, false), missing / "a.png");
  EXPECT_THROW(sequence.finish(), render::FileError);
  EXPECT_THROW(sequence.submit(patterned(8, 8, false), missing / "b.png"), render::FileError);
}

TEST(PngSequence, DestructorWritesWhatWasSubmittedAndThrowsNothing) {
  const fs::path folder = fresh_folder("png_destructor");
  {
    render::PngSequence sequence(1);
    for (int i = 0; i < 3; ++i)
      sequence.submit(patterned(90, 90, false), folder / (std::to_string(i) + ".png"));
  }
  EXPECT_EQ(entries(folder), 3u);
  render::PngSequence failing(1);
  failing.submit(patterned(8, 8, false), folder / "missing" / "a.png");
}

}  // namespace
