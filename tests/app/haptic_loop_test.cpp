// The example program in real time, run briefly: what it prints makes sense (how long it took is not judged).
#include <gmock/gmock.h>

#include <cstdio>
#include <string>

namespace app_tests {
namespace {

struct Output {
  std::string text;
  int status = -1;
};

Output haptic_loop(const std::string& arguments) {
  Output output;
  FILE* pipe = popen(("'" RHEO_HAPTIC_LOOP "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) output.text += buffer;
  output.status = pclose(pipe);
  return output;
}

TEST(HapticLoop, PrintsForceTicksAndJitter) {
  const Output output = haptic_loop("--seconds 0.3 --rate 200 --triangles 50");
  ASSERT_EQ(output.status, 0) << output.text;
  int triangles = 0, threads = 0, ticks = 0;
  long long steps = 0, missed = 0;
  double rate = 0.0, force = 0.0;
  ASSERT_EQ(std::sscanf(output.text.c_str(),
                        "%d triangles, %lf Hz, %lld steps a tick, %d threads; strongest force %lf N",
                        &triangles, &rate, &steps, &threads, &force),
            5)
      << output.text;
  EXPECT_EQ(triangles, 50);
  EXPECT_EQ(rate, 200.0);
  EXPECT_EQ(threads, 1);
  EXPECT_GE(steps, 1);
  EXPECT_LE(steps, 20);
  // Some millimetres into a block of 20 kPa, 50 mm thick, with a finger of 30 mm.
  EXPECT_GT(force, 0.3);
  EXPECT_LT(force, 30.0);
  for (const char* name : {"tick ", "woken late "}) {
    const std::size_t at = output.text.find(name, output.text.find('\n'));
    ASSERT_NE(at, std::string::npos) << output.text;
    double median = -1.0, most = -1.0, nearly_all = -1.0, worst = -1.0;
    ASSERT_EQ(std::sscanf(output.text.c_str() + output.text.find("median", at),
                          "median %lf 95%% %lf 99%% %lf worst %lf", &median, &most, &nearly_all, &worst),
              4);
    EXPECT_GE(median, 0.0);
    EXPECT_LE(median, most);
    EXPECT_LE(most, nearly_all);
    EXPECT_LE(nearly_all, worst);
  }
  const std::size_t last = output.text.rfind('\n', output.text.size() - 2) + 1;
  ASSERT_EQ(std::sscanf(output.text.c_str() + last, "%d ticks, %lld longer", &ticks, &missed), 2)
      << output.text;
  EXPECT_EQ(ticks, 60);
  EXPECT_LE(missed, ticks);
}

TEST(HapticLoop, AMistakeIsOneLine) {
  for (const char* arguments : {"--rate 0", "--rate", "--triangles many", "--fast 3"}) {
    const Output output = haptic_loop(arguments);
    EXPECT_EQ(output.status >> 8, 2) << arguments;
    EXPECT_EQ(std::count(output.text.begin(), output.text.end(), '\n'), 1) << output.text;
  }
}

}  // namespace
}  // namespace app_tests
