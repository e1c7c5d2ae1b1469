// What happens to a run from outside: it is killed, told to stop, its disk is full, its folder goes, nobody
// reads what it prints, memory is out. No file is ever half there, and a run goes on where it was.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "child.hpp"
#include "kills.hpp"
#include "rheo/io/checkpoint.hpp"

namespace fault_tests {
namespace {

using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using Strings = std::vector<std::string>;

#ifdef RHEO_SANITIZE_ADDRESS
constexpr double run_length = 0.3, held_length = 3.0;
#else
constexpr double run_length = 1.0, held_length = 10.0;  // held at some tenth of it on a quick machine
#endif

#ifdef RHEO_HAS_RENDERER
constexpr bool pictures = true;
#else
constexpr bool pictures = false;
#endif

class Faults : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(RHEO_TEST_OUTPUT) / (std::string(test->test_suite_name()) + "." + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    use(run_cases(held_length, pictures).front());
  }

  // Its scene and an undisturbed run of it, to compare with.
  void use(const RunCase& each) {
    case_ = each;
    std::ofstream(folder_ / "scene.toml", std::ios::binary) << each.scene;
    const fs::path whole = folder_ / "undisturbed";
    fs::remove_all(whole);
    fs::create_directories(whole);
    std::ofstream(whole / "scene.toml", std::ios::binary) << each.scene;
    const Ended ended = run(whole, each.arguments);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
  }

  Strings with(const Strings& more) const {
    Strings arguments = case_.arguments;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  fs::path results() const { return folder_ / "r"; }
  fs::path undisturbed() const { return folder_ / "undisturbed/r"; }

  // A run held well before its end, with a checkpoint to go on from; one that was too quick is run again.
  std::unique_ptr<Child> held_run(const std::function<void()>& prepare = {}) const {
    for (int trial = 0; trial < 50; ++trial) {
      const fs::path file = results() / "checkpoint.rheo";
      if (fs::exists(results()))
        for (const fs::directory_entry& entry : fs::directory_iterator(results())) fs::remove_all(entry);
      auto child = std::make_unique<Child>(folder_, case_.arguments, prepare);
      if (!child->wait_until([&] { return fs::exists(file); }) || !child->pause()) continue;
      if (rheo::read_checkpoint(file).snapshot.state.t < 0.7 * 2.0 * held_length) return child;
    }
    return nullptr;
  }

  void expect_line(const Ended& ended, int exit_code, const Strings& parts) const {
    EXPECT_EQ(ended.signal, 0);
    EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("rheo: "));
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    for (const std::string& part : parts) EXPECT_THAT(ended.err, HasSubstr(part));
  }

  // The same command with --resume comes to the undisturbed end.
  void expect_resumed_to_the_same_end() const {
    const Ended ended = run(folder_, with({"--resume"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(differences(results(), undisturbed()), IsEmpty());
  }

  fs::path folder_;
  RunCase case_;
};

TEST_F(Faults, KilledAtRandomMomentsARunGoesOnToTheSameEnd) {
  std::mt19937_64 random(20260711);
  const std::vector<RunCase> cases = run_cases(run_length, pictures);
  const KillReport run = kill_and_resume(cases.front(), 3, random, folder_ / "run");
  EXPECT_EQ(run.kills, 3);
  EXPECT_THAT(run.faults, IsEmpty());
  const KillReport one = kill_and_resume(*(cases.end() - 2), 2, random, folder_ / "one");
  EXPECT_EQ(one.kills, 2);
  EXPECT_THAT(one.faults, IsEmpty());
  const KillReport last = kill_and_resume(cases.back(), 2, random, folder_ / "last");
  EXPECT_EQ(last.kills, 2);
  EXPECT_THAT(last.faults, IsEmpty());
}

TEST_F(Faults, ASignalEndsTheRunAfterTheOutputInHandAndItGoesOn) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, std::pair{SIGTERM, "SIGTERM"}}) {
    const auto child = held_run();
    ASSERT_TRUE(child);
    child->send(signal);
    child->send(SIGCONT);
    const Ended ended = child->wait();
    expect_line(ended, 128 + signal, {name, "--resume"});
    EXPECT_THAT(ended.out, HasSubstr("force evaluations"));
    const auto json = nlohmann::json::parse(read_text(results() / "run.json"));
    EXPECT_EQ(json.at("exit_status"), 128 + signal);
    EXPECT_GT(json.at("outputs"), 0);
    EXPECT_THAT(json.at("files"), Contains("checkpoint.rheo"));
    EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
    // The checkpoint is the last output's.
    const auto checkpoint = rheo::read_checkpoint(results() / "checkpoint.rheo");
    EXPECT_NEAR(checkpoint.snapshot.state.t, (json.at("outputs").get<double>() - 1.0) / 200.0, 1e-12);
    expect_resumed_to_the_same_end();
  }
}

TEST_F(Faults, ResumeSaysWhatThereIsToGoOnFrom) {
  const Ended anew = run(folder_, with({"--resume"}));
  EXPECT_EQ(anew.exit_code, 0) << anew.err;
  EXPECT_THAT(anew.out, HasSubstr("no checkpoint to go on from: begins at t = 0"));
  const std::string before = read_text(results() / "run.json");
  std::ofstream(results() / "positions.bin.part") << "killed before it went";
  const Ended again = run(folder_, with({"--resume"}));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_FALSE(fs::exists(results() / "positions.bin.part"));
  EXPECT_THAT(again.out, HasSubstr("has ended: nothing to resume"));
  EXPECT_EQ(read_text(results() / "run.json"), before);
  expect_line(run(folder_, with({"--resume", "--force"})), 2, {"--resume and --force"});
}

TEST_F(Faults, AnotherRunIsNotGoneOnWith) {
  const auto child = held_run();
  ASSERT_TRUE(child);
  child->send(SIGKILL);
  child->wait();
  const std::string checkpoint = read_text(results() / "checkpoint.rheo");
  expect_line(run(folder_, with({"--resume", "--duration", "3"})), 2, {"checkpoint.rheo", "--duration", "3"});
  expect_line(run(folder_, with({"--resume", "--kernel", "csr"})), 2, {"checkpoint.rheo", "--kernel"});
  std::ofstream(folder_ / "scene.toml", std::ios::binary) << case_.scene << "# another\n";
  expect_line(run(folder_, with({"--resume"})), 2, {"checkpoint.rheo", "scene file's content"});
  std::ofstream(folder_ / "scene.toml", std::ios::binary) << case_.scene;
  // Damaged: refused, and nothing is touched.
  std::string damaged = checkpoint;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  std::ofstream(results() / "checkpoint.rheo", std::ios::binary) << damaged;
  expect_line(run(folder_, with({"--resume"})), 2, {"checkpoint.rheo", "damaged", "begin the run anew"});
  std::ofstream(results() / "checkpoint.rheo", std::ios::binary) << checkpoint;
  expect_resumed_to_the_same_end();
}

TEST_F(Faults, APartThatIsNotTheCheckpointsIsRefused) {
  const auto child = held_run();
  ASSERT_TRUE(child);
  child->send(SIGKILL);
  child->wait();
  std::string part = read_text(results() / "history.csv.part");
  part[part.find('\n') + 3] ^= 1;
  std::ofstream(results() / "history.csv.part", std::ios::binary) << part;
  expect_line(run(folder_, with({"--resume"})), 4, {"history.csv.part", "--force"});
  EXPECT_EQ(read_text(results() / "history.csv.part"), part);
}

TEST_F(Faults, TwoProgramsDoNotShareAFolder) {
  const auto child = held_run();
  ASSERT_TRUE(child);
  std::ofstream(folder_ / "other.toml", std::ios::binary) << case_.scene;
  const fs::path elsewhere = folder_ / "elsewhere";
  fs::create_directories(elsewhere);
  const Ended other = run(elsewhere, {"run", "../scene.toml", "-o", "../r", "--force"});
  expect_line(other, 4, {"another rheo is writing into it"});
  child->send(SIGCONT);
  EXPECT_EQ(child->wait().exit_code, 0);
  EXPECT_THAT(differences(results(), undisturbed()), IsEmpty());
}

// --from: the end of one run is the beginning of another, on the same mesh only.
TEST_F(Faults, ARunBeginsFromACheckpoint) {
  const std::string start = (undisturbed() / "checkpoint.rheo").string();
  const Ended next = run(folder_, {"run", "scene.toml", "-o", "next", "--duration", "0.1", "--frame-rate",
                                   "10", "--from", start});
  ASSERT_EQ(next.exit_code, 0) << next.err;
  // The first row of the second is the last of the first, but for the time.
  const std::string last = read_text(undisturbed() / "history.csv");
  const std::string first = read_text(folder_ / "next/history.csv");
  const std::string last_row = last.substr(last.rfind('\n', last.size() - 2) + 1);
  const std::string first_row = first.substr(first.find('\n') + 1);
  const auto norms = [](const std::string& row) {
    const std::size_t begin = row.find(',');
    std::size_t end = begin;
    for (int k = 0; k < 3; ++k) end = row.find(',', end + 1);
    return row.substr(begin, end - begin);
  };
  EXPECT_EQ(norms(first_row), norms(last_row));
  std::string other = case_.scene;
  other.replace(other.find("[41, 11]"), 8, "[41, 12]");
  std::ofstream(folder_ / "other.toml", std::ios::binary) << other;
  expect_line(run(folder_, {"run", "other.toml", "-o", "none", "--from", start}), 2,
              {"checkpoint.rheo", "another mesh"});
  EXPECT_FALSE(fs::exists(folder_ / "none"));
  expect_line(run(folder_, {"run", "scene.toml", "-o", "none", "--from", "scene.toml"}), 2,
              {"scene.toml", "is not a checkpoint"});
  expect_line(run(folder_, {"run", "scene.toml", "-o", "none", "--from", "nothing"}), 4, {"nothing"});
}

void limit_files_to(rlim_t bytes) {
  const rlimit limit{bytes, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(Faults, AFullDiskIsOneLineAndTheRunGoesOnWhenThereIsRoom) {
  const auto size = static_cast<rlim_t>(fs::file_size(undisturbed() / "history.csv"));
  ASSERT_GT(fs::file_size(undisturbed() / "checkpoint.rheo"), 4096u);
  for (const rlim_t room : {rlim_t{4096}, size / 2, size - 1}) {
    fs::remove_all(results());
    const Ended ended = run(folder_, case_.arguments, [&] { limit_files_to(room); });
    expect_line(ended, 4, {"File too large"});
    EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
    expect_resumed_to_the_same_end();
  }
}

TEST_F(Faults, AFolderThatGoesIsOneLine) {
  const auto child = held_run();
  ASSERT_TRUE(child);
  fs::remove_all(results());
  child->send(SIGCONT);
  expect_line(child->wait(), 4, {"r: is gone"});
  EXPECT_FALSE(fs::exists(results()));
}

TEST_F(Faults, AFolderThatBecomesReadOnlyIsOneLine) {
  constexpr uid_t nobody = 65534;
  const bool as_root = geteuid() == 0;
  if (as_root) {
    fs::create_directories(results());
    if (chown(results().c_str(), nobody, nobody) != 0) GTEST_SKIP() << "cannot give a folder away";
  }
  const auto prepare = [&] {
    if (as_root && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(125);
  };
  // A whole short run: LLVM's OpenMP, for one, ends a program whose user may not write to /dev/shm.
  if (const Ended probe = run(folder_, with({"--duration", "0.02"}), prepare); probe.exit_code != 0)
    GTEST_SKIP() << "cannot be run by another user: " << probe.err;
  const auto child = held_run(prepare);
  ASSERT_TRUE(child);
  fs::permissions(results(), fs::perms::owner_read | fs::perms::owner_exec);
  child->send(SIGCONT);
  expect_line(child->wait(), 4, {"Permission denied"});
  EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
  fs::permissions(results(), fs::perms::owner_all);
  const Ended ended = run(folder_, with({"--resume"}), prepare);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(differences(results(), undisturbed()), IsEmpty());
}

// Nobody reads: the results are whole, and the exit code says that the lines are lost.
TEST_F(Faults, StandardOutputThatCannotBeWrittenIsOneLine) {
  const auto closed = [] { close(1); };
  const auto without_reader = [] {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) == 0) dup2(ends[1], 1);
    close(ends[0]);
    close(ends[1]);
  };
  const auto full = [] {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_NONBLOCK) != 0) return;
    const std::array<char, 4096> block{};
    while (write(ends[1], block.data(), block.size()) > 0) continue;
    while (write(ends[1], block.data(), 1) > 0) continue;
    dup2(ends[1], 1);
    // The reading end stays open, at a number that the program does not use.
    dup2(ends[0], 100);
    close(ends[0]);
    close(ends[1]);
  };
  // Nothing is waited for on the disk here.
  std::ranges::replace(case_.arguments, std::string(often), std::string("never"));
  use(case_);
  const std::vector<std::pair<std::function<void()>, const char*>> ways{
      {closed, "Bad file descriptor"}, {without_reader, "Broken pipe"}, {full, "temporarily unavailable"}};
  for (const auto& [prepare, reason] : ways) {
    fs::remove_all(results());
    expect_line(run(folder_, case_.arguments, prepare), 4, {"standard output", reason});
    EXPECT_THAT(differences(results(), undisturbed()), IsEmpty());
    fs::remove_all(results());
    EXPECT_EQ(run(folder_, with({"--quiet"}), prepare).exit_code, 0);
  }
  // All three closed: no file of the run gets their numbers.
  fs::remove_all(results());
  const Ended mute = run(folder_, case_.arguments, [] {
    for (const int stream : {0, 1, 2}) close(stream);
  });
  EXPECT_EQ(mute.exit_code, 4);
  EXPECT_THAT(differences(results(), undisturbed()), IsEmpty());
}

// The address sanitizer reserves more than any limit.
#if !defined(RHEO_SANITIZE_ADDRESS)
TEST_F(Faults, MemoryThatRunsOutIsOneLine) {
  const std::string scene = [&] {
    std::string text = case_.scene;
    return text.replace(text.find("[41, 11]"), 8, "[201, 51]");
  }();
  std::ofstream(folder_ / "large.toml", std::ios::binary) << scene;
  int refused = 0, done = 0;
  for (rlim_t megabytes = 16; megabytes <= 76; megabytes += 6) {
    fs::remove_all(folder_ / "large");
    const Ended ended =
        run(folder_, {"run", "large.toml", "-o", "large", "--duration", "0.001", "--threads", "2"}, [&] {
          const rlimit limit{megabytes << 20, megabytes << 20};
          setrlimit(RLIMIT_AS, &limit);
        });
    // Below some size the system cannot load the program.
    if (ended.exit_code == 127 && ended.err.find("error while loading shared libraries") != std::string::npos)
      continue;
    EXPECT_EQ(ended.signal, 0) << megabytes << " MB: " << ended.err;
    EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 4) << megabytes << " MB: " << ended.err;
    if (ended.exit_code == 0) ++done;
    if (ended.exit_code != 4) continue;
    expect_line(ended, 4, {"memory"});
    EXPECT_THAT(ended.err, testing::AnyOf(HasSubstr("10251 nodes need about"), HasSubstr("no room to read")));
    ++refused;
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(done, 0);
}

#ifdef RHEO_HAS_RENDERER
// Libraries that draw end the program where they get no addresses: they are not asked to. Tables are made all
// the same.
TEST_F(Faults, DrawingWithoutAddressesIsOneLine) {
  std::ofstream(folder_ / "scene.toml", std::ios::binary) << case_.scene;
  for (const rlim_t megabytes : {200, 250, 400}) {
    const auto prepare = [&] {
      const rlimit limit{megabytes << 20, megabytes << 20};
      setrlimit(RLIMIT_AS, &limit);
    };
    const Ended plot = run(folder_, {"check", "scene.toml", "--plot", "-o", "plot", "--force"}, prepare);
    EXPECT_EQ(plot.exit_code, 0) << plot.err;
    EXPECT_THAT(plot.out, HasSubstr("no picture: no room to draw"));
    EXPECT_TRUE(fs::exists(folder_ / "plot/relaxation.csv"));
    const Ended drawn = run(folder_, {"render", "scene.toml", "-o", "drawn", "--force"}, prepare);
    expect_line(drawn, 4, {"need about", "ulimit -v"});
#ifdef RHEO_HAS_WINDOW
    const Ended view = run(folder_, {"view", "scene.toml", "--close-after", "1"}, prepare);
    expect_line(view, 4, {"no room to draw", "ulimit -v"});
#endif
    const Ended bench =
        run(folder_, {"bench", "scene.toml", "-o", "bench", "--force", "--duration", "0.01", "--budget", "1"},
            prepare);
    EXPECT_EQ(bench.exit_code, 0) << bench.err;
    EXPECT_THAT(bench.out, HasSubstr("no picture: no room to draw"));
    EXPECT_TRUE(fs::exists(folder_ / "bench/bench.csv"));
  }
}
#endif
#endif

#ifdef RHEO_HAS_RENDERER

class FaultsOfPictures : public Faults {
 protected:
  void SetUp() override {
    Faults::SetUp();
    use(run_cases(run_length, true).back());
  }
  bool wait_for_frame(Child& child, const char* frame) const {
    return child.wait_until([&] { return fs::exists(results() / "frames" / frame); });
  }
};

TEST_F(FaultsOfPictures, ASignalWhileDrawingKeepsTheFramesAndTheRunGoesOnWithTheNext) {
  Child child(folder_, case_.arguments);
  ASSERT_TRUE(wait_for_frame(child, "frame_00003.png"));
  child.send(SIGINT);
  const Ended ended = child.wait();
  expect_line(ended, 130, {"while drawing", "--resume"});
  EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
  EXPECT_TRUE(fs::exists(results() / "history.csv"));
  EXPECT_TRUE(fs::exists(results() / "state.csv"));
  const auto written = fs::last_write_time(results() / "frames/frame_00002.png");
  expect_resumed_to_the_same_end();
  EXPECT_EQ(fs::last_write_time(results() / "frames/frame_00002.png"), written) << "drawn again";
}

TEST_F(FaultsOfPictures, KilledWhileDrawingItGoesOnWithoutSimulatingAnew) {
  Child child(folder_, case_.arguments);
  // A fast machine draws twenty frames before the first checkpoint is due.
  ASSERT_TRUE(child.wait_until([&] {
    return fs::exists(results() / "frames/frame_00020.png") && fs::exists(results() / "checkpoint.rheo");
  }));
  child.send(SIGKILL);
  child.wait();
  EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
  const auto checkpoint = rheo::read_checkpoint(results() / "checkpoint.rheo");
  EXPECT_GT(checkpoint.snapshot.state.t, 0.0);
  expect_resumed_to_the_same_end();
}

TEST_F(FaultsOfPictures, AnotherChoiceOfFramesIsNotGoneOnWith) {
  Child child(folder_, case_.arguments);
  ASSERT_TRUE(wait_for_frame(child, "frame_00003.png"));
  child.send(SIGINT);
  child.wait();
  expect_line(run(folder_, with({"--resume", "--every", "3"})), 2, {"checkpoint.rheo", "--every 1, not 3"});
  expect_resumed_to_the_same_end();
}

TEST_F(FaultsOfPictures, ADiskThatIsFullOfFramesIsOneLine) {
  const auto room = static_cast<rlim_t>(fs::file_size(undisturbed() / "frames/frame_00030.png") - 1);
  const Ended ended = run(folder_, with({"--checkpoint", "never"}), [&] { limit_files_to(room); });
  EXPECT_EQ(ended.exit_code, 2) << "--checkpoint twice";
  Strings arguments = case_.arguments;
  std::ranges::replace(arguments, std::string(often), std::string("never"));
  const Ended full = run(folder_, arguments, [&] { limit_files_to(room); });
  expect_line(full, 4, {"File too large"});
  EXPECT_THAT(faults_in(results(), undisturbed()), IsEmpty());
  expect_resumed_to_the_same_end();
}

#endif

}  // namespace
}  // namespace fault_tests
