#include "io/message.hpp"

#include <gtest/gtest.h>

#include <array>

namespace rheo {
namespace {

const std::array<std::string, 4> words{"lambda_ela", "mu_ela", "density", "w"};

TEST(Message, FindsTheNearestWordOrNone) {
  EXPECT_EQ(nearest_word("lamda_ela", words), "lambda_ela");
  EXPECT_EQ(nearest_word("Density", words), "density");
  EXPECT_EQ(nearest_word("desnity", words), "density");
  EXPECT_EQ(nearest_word("temperature", words), "");
  EXPECT_EQ(nearest_word("q", words), "") << "one other letter is no slip of a word of one";
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'x'), words), "");
}

TEST(Message, KeepsTextOnOneLine) {
  EXPECT_EQ(one_line("a\nb\t\x7f"), "a\\x0Ab\\x09\\x7F");
  EXPECT_EQ(one_line("Gr\xC3\xBC\xC3\x9F"
                     "e"),
            "Gr\xC3\xBC\xC3\x9F"
            "e")
      << "UTF-8 stays";
  EXPECT_EQ(one_line("\xFF\xC3"), "\\xFF\\xC3");
  EXPECT_EQ(one_line("\xC2\x85"), "\\xC2\\x85") << "a control character in UTF-8";
  EXPECT_EQ(one_line("abcdef", 3), "abc...");
  EXPECT_EQ(in_quotes("a"), "\"a\"");
}

TEST(Message, ListsWords) {
  EXPECT_EQ(word_list(words), "\"lambda_ela\", \"mu_ela\", \"density\" or \"w\"");
  EXPECT_EQ(word_list(std::array<std::string, 1>{"x"}), "\"x\"");
  EXPECT_EQ(word_list({}), "");
}

}  // namespace
}  // namespace rheo
