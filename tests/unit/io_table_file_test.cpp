// Tables of numbers in CSV files.
#include "io/table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_error_of.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

NumberTable parse(std::string_view text) {
  return parse_table(text, "a.csv", 3, "t, x, y");
}
std::string refusal(std::string_view text) {
  return error_of([&] { parse(text); });
}

TEST(TableFile, ReadsNumbersHeadersCommentsAndWindowsLines) {
  const auto table =
      parse("\xEF\xBB\xBF# measured by hand\r\nt, x, y\r\n0,1,-2.5e-3\r\n\r\n+1 , 2,3 # last\r\n4,5,6");
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre(0.0, 1.0, -2.5e-3), ElementsAre(1.0, 2.0, 3.0),
                                      ElementsAre(4.0, 5.0, 6.0)));
  EXPECT_THAT(table.lines, ElementsAre(3, 5, 6));
  EXPECT_EQ(parse("1,2,3\n").rows.size(), 1u) << "the header may be left out";
}

TEST(TableFile, SemicolonsAndTabsSeparateToo) {
  for (const char* text : {"t; x; y\n0; 1; 2\n3;4;5\n", "t\tx\ty\n0\t1\t2\n3\t4\t5\n"})
    EXPECT_THAT(parse(text).rows, ElementsAre(ElementsAre(0.0, 1.0, 2.0), ElementsAre(3.0, 4.0, 5.0)))
        << text;
}

TEST(TableFile, NamesTheLineAndWhatIsNeeded) {
  EXPECT_THAT(refusal("1,2,3\n4,5\n"),
              AllOf(StartsWith("a.csv:2: "), HasSubstr("only 2 columns"), HasSubstr("t, x, y")));
  EXPECT_THAT(refusal("1,2,3,4\n"), AllOf(StartsWith("a.csv:1: "), HasSubstr("more than 3")));
  EXPECT_THAT(refusal("1 2 3\n"),
              AllOf(HasSubstr("only 1 column:"), HasSubstr("separated by commas, semicolons or tabs")));
  EXPECT_THAT(refusal("0,5;1;2\n"), HasSubstr("\"0,5\" is no finite number")) << "a decimal comma";
  EXPECT_THAT(refusal("t,x,y\nt,x,y\n"),
              AllOf(StartsWith("a.csv:2: "), HasSubstr("\"t\" is no finite number")));
  EXPECT_THAT(refusal("1,,3\n"), HasSubstr("\"\" is no finite number"));
  EXPECT_THAT(refusal("O.0,1,2\n1,2,3\n"), AllOf(StartsWith("a.csv:1: "), HasSubstr("\"O.0\" is no finite")));
  for (const char* bad : {"nan", "inf", "1e999", "0x10", "1 2", "--1", "+-1", "1,5e"}) {
    EXPECT_THAT(refusal(std::string("1,2,") + bad), StartsWith("a.csv:1: ")) << bad;
  }
  for (const char* empty : {"", "\n\n", "# only a comment\n", "t,x,y\n"}) {
    EXPECT_THAT(refusal(empty), HasSubstr("no numbers")) << empty;
  }
}

}  // namespace
}  // namespace rheo
