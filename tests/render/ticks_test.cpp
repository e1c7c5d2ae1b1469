#include "ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "typeset.hpp"

namespace {

using render::linear_ticks;
using render::log_ticks;
using Strings = std::vector<std::string>;

TEST(Ticks, AreRoundNumbersInsideOfTheRange) {
  EXPECT_EQ(linear_ticks(0, 1, 6).labels, (Strings{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(linear_ticks(-3.1, 7, 7).labels, (Strings{"−2", "0", "2", "4", "6"}));
  for (const double scale : {1e-12, 3.7e-4, 1.0, 42.0, 8.9e9}) {
    for (int most = 2; most < 12; ++most) {
      const auto ticks = linear_ticks(-0.31 * scale, scale, most);
      EXPECT_GE(ticks.at.size(), 1u);
      EXPECT_LE(ticks.at.size(), static_cast<std::size_t>(most) + 1);
      EXPECT_EQ(std::set<std::string>(ticks.labels.begin(), ticks.labels.end()).size(), ticks.labels.size());
      for (const double v : ticks.at) {
        EXPECT_GE(v, -0.3101 * scale);
        EXPECT_LE(v, 1.0001 * scale);
      }
    }
  }
}

TEST(Ticks, AScaleHasTwoNumbersHoweverFewAreAskedFor) {
  EXPECT_EQ(linear_ticks(0, 118, 2).labels, (Strings{"0", "100"}));
  for (double high = 1; high < 10.05; high += 0.1) {
    for (const double low : {0.0, -0.37 * high, 0.77 * high}) {
      for (int most = 2; most < 10; ++most) {
        const auto ticks = linear_ticks(low, high, most);
        EXPECT_GE(ticks.at.size(), 2u) << low << " " << high << " " << most;
        EXPECT_LE(ticks.at.size(), static_cast<std::size_t>(most) + 2) << low << " " << high << " " << most;
      }
    }
  }
}

TEST(Ticks, LongNumbersGetAPowerOfTen) {
  const auto small = linear_ticks(0, 4e-5, 5);
  EXPECT_EQ(small.exponent, -5);
  EXPECT_EQ(small.labels, (Strings{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(linear_ticks(0, 3e6, 4).exponent, 6);
  EXPECT_EQ(linear_ticks(0, 9999, 4).exponent, 0);
}

TEST(Ticks, UnusableRangesGiveNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(linear_ticks(1, 1, 5).at.empty());
  EXPECT_TRUE(linear_ticks(2, 1, 5).at.empty());
  EXPECT_TRUE(linear_ticks(nan, 1, 5).at.empty());
  EXPECT_TRUE(linear_ticks(0, inf, 5).at.empty());
  EXPECT_TRUE(linear_ticks(1e20, std::nextafter(1e20, 2e20), 5).at.empty());
  EXPECT_TRUE(log_ticks(0, 10, 5).at.empty());
  EXPECT_TRUE(log_ticks(-1, 10, 5).at.empty());
  EXPECT_TRUE(log_ticks(1, nan, 5).at.empty());
}

TEST(Ticks, LogarithmicOnesAreDecades) {
  EXPECT_EQ(log_ticks(1e-3, 1, 9).labels, (Strings{"10^{-3}", "10^{-2}", "10^{-1}", "10^{0}"}));
  EXPECT_LE(log_ticks(1e-12, 1e12, 6).at.size(), 7u);
  EXPECT_EQ(log_ticks(1.5, 6, 6).labels, (Strings{"2×10^{0}", "5×10^{0}"}));
}

TEST(Numbers, CarryPrefixesAndTimeItsUnit) {
  EXPECT_EQ(render::with_unit(10, "Pa"), "10 Pa");
  EXPECT_EQ(render::with_unit(2500, "Pa"), "2.5 kPa");
  EXPECT_EQ(render::with_unit(0, "Pa"), "0 Pa");
  EXPECT_EQ(render::with_unit(3.2e-4, "Pa"), "320 µPa");
  EXPECT_EQ(render::time_text(0), "t = 0.000 s");
  EXPECT_EQ(render::time_text(0.51666), "t = 0.517 s");
  EXPECT_EQ(render::time_text(0.0002), "t = 0.200 ms");
  EXPECT_EQ(render::time_text(0.0002, 0.009), "t = 0.200 ms");
  EXPECT_EQ(render::time_text(0, 0.009), "t = 0.000 ms");
  EXPECT_EQ(render::time_text(0.002, 3), "t = 0.002 s");
}

TEST(Typeset, NamesOfQuantities) {
  const auto w = render::typeset("|w_lambda|");
  ASSERT_EQ(w.size(), 3u);
  EXPECT_EQ(w[0].text, "|w");
  EXPECT_EQ(w[1].text, "λ");
  EXPECT_EQ(w[1].level, render::Level::lower);
  EXPECT_EQ(w[2].text, "|");
  const auto power = render::typeset("10^-3 Pa m");
  ASSERT_EQ(power.size(), 3u);
  EXPECT_EQ(power[1].text, "−3");
  EXPECT_EQ(power[1].level, render::Level::raised);
  EXPECT_EQ(power[2].text, " Pa m");
}

TEST(Typeset, LeavesOtherTextAlone) {
  for (const char* text : {"speed [m/s]", "a_", "^", "x _ y", "_", "a_{open", "mutual"}) {
    std::string whole;
    for (const auto& run : render::typeset(text)) whole += run.text;
    EXPECT_EQ(whole, text);
  }
}

TEST(LogTicks, AreTwoAtLeastWhereTheRangeHasTwoPowers) {
  for (int first = -5; first < 5; ++first) {
    for (int decades = 1; decades < 8; ++decades) {
      const auto ticks = log_ticks(std::pow(10, first - 0.3), std::pow(10, first + decades + 0.3), 2);
      EXPECT_GE(ticks.at.size(), 2u) << first << " " << decades;
    }
  }
}

TEST(LogTicks, AreRoundNumbersWhereTheRangeIsShorterThanTheirSteps) {
  for (const auto& [low, high] :
       {std::pair{5.0, 7.0}, std::pair{2.2, 4.5}, std::pair{6e6, 9e6}, std::pair{0.51, 0.99}}) {
    const auto ticks = log_ticks(low, high, 5);
    EXPECT_GE(ticks.at.size(), 2u) << low;
    for (const double at : ticks.at) EXPECT_TRUE(at >= low * (1 - 1e-9) && at <= high * (1 + 1e-9)) << at;
  }
}

TEST(ShortTimes, HaveOneUnitAndNoMoreDecimalsThanTheyNeed) {
  using testing::ElementsAre;
  const auto of = [](std::vector<double> t) { return render::short_times(t); };
  EXPECT_THAT(of({0, 1, 2}), ElementsAre("0 s", "1 s", "2 s"));
  EXPECT_THAT(of({0, 0.25, 12}), ElementsAre("0.00 s", "0.25 s", "12.00 s"));
  EXPECT_THAT(of({0, 1.0 / 3}), ElementsAre("0.000 s", "0.333 s"));
  EXPECT_THAT(of({0, 0.002, 0.0045}), ElementsAre("0.0 ms", "2.0 ms", "4.5 ms"));
  EXPECT_THAT(of({0, 3e-6}), ElementsAre("0 µs", "3 µs"));
  EXPECT_THAT(of({0, 1234.567}), ElementsAre("0.0 s", "1234.6 s"));
  EXPECT_THAT(of({0}), ElementsAre("0 s"));
  EXPECT_THAT(of({}), ElementsAre());
}

}  // namespace
