// Files appear whole or not at all.
#include "rheo/io/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_error_of.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_text;
using testing::write_text;

TEST(AtomicFile, AppearsOnCommitOnly) {
  const fs::path file = fresh_folder("atomic") / "a.txt";
  AtomicFile out(file);
  out.write("one ");
  out.write("two");
  EXPECT_FALSE(fs::exists(file));
  out.commit();
  EXPECT_EQ(read_text(file), "one two");
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

TEST(AtomicFile, LeavesTheOlderFileWithoutCommit) {
  const fs::path file = fresh_folder("atomic_old") / "a.txt";
  write_text(file, "old");
  {
    AtomicFile out(file);
    out.write("new");
  }
  EXPECT_EQ(read_text(file), "old");
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

TEST(AtomicFile, ReplacesTheOlderFileOnCommit) {
  const fs::path file = fresh_folder("atomic_new") / "a.txt";
  write_text(file, "a longer old text");
  AtomicFile out(file);
  out.write(std::string_view("\0\n", 2));
  out.commit();
  EXPECT_EQ(read_text(file), std::string("\0\n", 2));
}

TEST(AtomicFile, SaysWhichPathAndWhy) {
  const fs::path folder = fresh_folder("atomic_bad");
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "none" / "a.txt"); }, Error::Kind::file),
              AllOf(HasSubstr((folder / "none" / "a.txt").string()), HasSubstr("No such file or directory")));
  EXPECT_THAT(error_of([&] { AtomicFile{folder}; }, Error::Kind::file), HasSubstr("Is a directory"));
}

TEST(AtomicFile, NoticesAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const fs::path folder = fresh_folder("atomic_full");
  fs::create_symlink("/dev/full", folder / "a.txt.part");
  const std::string text(1 << 20, 'x');
  EXPECT_THAT(error_of(
                  [&] {
                    AtomicFile out(folder / "a.txt");
                    out.write(text);
                    out.commit();
                  },
                  Error::Kind::file),
              HasSubstr("No space left on device"));
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  // A few bytes stay in the buffer: the failure shows at the end, and the end says so.
  fs::create_symlink("/dev/full", folder / "b.txt.part");
  EXPECT_THAT(error_of(
                  [&] {
                    AtomicFile out(folder / "b.txt");
                    out.write("x");
                    out.commit();
                  },
                  Error::Kind::file),
              HasSubstr("No space left on device"));
  EXPECT_FALSE(fs::exists(folder / "b.txt"));
}

}  // namespace
}  // namespace rheo
