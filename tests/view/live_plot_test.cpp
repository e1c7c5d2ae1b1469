// Axes of the live plots.
#include "view/live_plot.hpp"

#include <gmock/gmock.h>

namespace view_tests {
namespace {

using app::view::axis_ticks;
using app::view::labelled_ticks;
using app::view::prefixed_unit;

TEST(ViewPlot, ThePrefixIsTheUnitsSoThatTicksArePlainNumbers) {
  EXPECT_EQ(prefixed_unit(0.6, "m").name, "mm");
  EXPECT_DOUBLE_EQ(0.5 / prefixed_unit(0.6, "m").size, 500.0);
  EXPECT_EQ(prefixed_unit(1.5, "m").name, "m");
  EXPECT_EQ(prefixed_unit(-2500.0, "Pa m").name, "kPa m");
  EXPECT_EQ(prefixed_unit(4e-4, "J").name, "\u00b5J");
  EXPECT_EQ(prefixed_unit(0.0, "N").name, "N");
}

TEST(ViewPlot, AnAxisHasTwoLabelsWhereTheyHaveRoom) {
  const auto always = [](const std::vector<double>&) { return true; };
  for (double high = 0.011; high < 1e4; high *= 1.13) {
    for (const int most : {1, 2, 3, 6}) {
      const std::vector<double> ticks = labelled_ticks(0.0, high, most, always);
      EXPECT_GE(ticks.size(), 2u) << high << ", " << most;
      EXPECT_EQ(ticks.front(), 0.0);
      EXPECT_LE(ticks.back(), high * (1 + 1e-9));
    }
  }
}

TEST(ViewPlot, LabelsThatDoNotFitAreFewer) {
  const auto few = [](const std::vector<double>& ticks) { return ticks.size() <= 3; };
  const std::vector<double> ticks = labelled_ticks(0.0, 4.2, 6, few);
  EXPECT_THAT(ticks, testing::ElementsAre(0.0, 2.0, 4.0));
  const auto one = [](const std::vector<double>& at) { return at.size() <= 1; };
  EXPECT_EQ(labelled_ticks(0.0, 4.2, 6, one).size(), 1u);
  EXPECT_TRUE(labelled_ticks(0.0, 4.2, 6, [](const std::vector<double>&) { return false; }).empty());
}

}  // namespace
}  // namespace view_tests
