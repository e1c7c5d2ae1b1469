// For every key of a scene file: missing, misspelt, of a wrong type, out of range, non-finite. The message
// names file, line, key, value, and what is allowed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "io_error_of.hpp"
#include "rheo/io/scene_file.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A scene that uses every key but those of the other mesh sources. Every line can be replaced by its number.
std::vector<std::string> all_keys() {
  return {
      "title = \"All\"",                              // 1
      "[mesh]",                                       // 2
      "shape = \"rectangle\"",                        // 3
      "size = [1.0, 0.25]",                           // 4
      "nodes = [5, 2]",                               // 5
      "diagonal = \"falling\"",                       // 6
      "thickness = 1.0",                              // 7
      "[edges]",                                      // 8
      "grip = [[4, 9]]",                              // 9
      "[material]",                                   // 10
      "lambda_ela = 7.0",                             // 11
      "mu_ela = 5.0",                                 // 12
      "lambda_vis = 4.0",                             // 13
      "mu_vis = 2.0",                                 // 14
      "density = 0.2",                                // 15
      "mass = \"consistent\"",                        // 16
      "[body_force]",                                 // 17
      "acceleration = [0.0, 0.0]",                    // 18
      "[[fix]]",                                      // 19
      "edges = \"left\"",                             // 20
      "axis = \"both\"",                              // 21
      "from = 0.0",                                   // 22
      "until = inf",                                  // 23
      "[[move]]",                                     // 24
      "nodes = [4, 9]",                               // 25
      "axis = \"x\"",                                 // 26
      "from = 1.0",                                   // 27
      "until = 2.0",                                  // 28
      "keys = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0]]",    // 29
      "profile = \"smooth\"",                         // 30
      "[[constraint]]",                               // 31
      "terms = [[9, \"x\", 1.0], [4, \"x\", -1.0]]",  // 32
      "value = 0.0",                                  // 33
      "[[traction]]",                                 // 34
      "edges = \"right\"",                            // 35
      "vector = [10.0, 0.0]",                         // 36
      "from = 0.0",                                   // 37
      "until = 1.0",                                  // 38
      "[[probe]]",                                    // 39
      "name = \"grip\"",                              // 40
      "edges = \"right\"",                            // 41
      "[time]",                                       // 42
      "duration = 5.0",                               // 43
      "frame_rate = 60",                              // 44
      "integrator = \"rk4\"",                         // 45
      "step = \"auto\"",                              // 46
      "baumgarte = 20.0",                             // 47
      "constraints = \"auto\"",                       // 48
      "[render]",                                     // 49
      "color = \"w_lambda\"",                         // 50
      "range = \"auto\"",                             // 51
      "size = [1280, 720]",                           // 52
      "every = 1",                                    // 53
  };
}

Scene parse_lines(const std::vector<std::string>& lines) {
  return parse_scene(fmt::format("{}\n", fmt::join(lines, "\n")), "bad.toml", RHEO_TEST_DATA);
}

std::string refusal_with(std::size_t line, const std::string& text) {
  auto lines = all_keys();
  lines.at(line - 1) = text;
  return error_of([&] { parse_lines(lines); });
}

std::string key_of(const std::string& line) {
  return line.substr(0, line.find(' '));
}

// "[material]" or "[[fix]]" above a line; empty above the first.
std::string header_above(std::size_t line) {
  const auto lines = all_keys();
  for (std::size_t i = line; i-- > 0;) {
    if (lines[i][0] == '[') return lines[i];
  }
  return {};
}

TEST(BadScene, TheWholeSceneIsGood) {
  EXPECT_NO_THROW(parse_lines(all_keys()));
}

TEST(BadScene, MisspeltKeysAreNamedWithTheNearestOne) {
  const auto lines = all_keys();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i][0] == '[' || key_of(lines[i]) == "grip") continue;
    const std::string key = key_of(lines[i]);
    const std::string wrong = key.substr(0, 1) + "q" + key.substr(1);  // one letter too many
    const std::string message = refusal_with(i + 1, wrong + lines[i].substr(key.size()));
    EXPECT_THAT(message, AllOf(StartsWith(fmt::format("bad.toml:{}: ", i + 1)),
                               HasSubstr(header_above(i + 1)), HasSubstr(wrong + " = "),
                               HasSubstr("unknown key"), HasSubstr("did you mean " + key + "?")));
  }
}

TEST(BadScene, MisspeltTablesAreNamedWithTheNearestOne) {
  const auto lines = all_keys();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i][0] != '[') continue;
    const std::size_t first = lines[i].find_first_not_of('[');
    const std::string name = lines[i].substr(first, lines[i].find(']') - first);
    std::string wrong = lines[i];
    wrong.insert(first + 1, "q");
    EXPECT_THAT(refusal_with(i + 1, wrong), AllOf(StartsWith(fmt::format("bad.toml:{}: ", i + 1)),
                                                  HasSubstr("did you mean " + name + "?")));
  }
}

TEST(BadScene, KeysFarFromAnyOtherListTheKnownOnes) {
  EXPECT_THAT(refusal_with(16, "temperature = 20"),
              HasSubstr("known here: lambda_ela, mu_ela, lambda_vis, mu_vis, density, mass"));
}

TEST(BadScene, MissingKeysAreNamedWithTheirMeaning) {
  for (const std::size_t line : {3, 4, 5, 11, 12, 13, 14, 15, 20, 25, 29, 32, 35, 36, 40, 41, 43}) {
    EXPECT_THAT(refusal_with(line, ""),
                AllOf(StartsWith("bad.toml:"), HasSubstr(header_above(line)),
                      HasSubstr(key_of(all_keys()[line - 1])), HasSubstr("is missing: ")))
        << "line " << line;
  }
}

TEST(BadScene, KeysWithADefaultMayBeMissing) {
  for (const std::size_t line :
       {1, 6, 7, 9, 16, 18, 21, 22, 23, 26, 27, 28, 30, 33, 37, 38, 44, 45, 46, 47, 48, 50, 51, 52, 53}) {
    auto lines = all_keys();
    lines[line - 1] = "";
    EXPECT_NO_THROW(parse_lines(lines)) << "line " << line;
  }
}

TEST(BadScene, MissingTablesAreNamed) {
  const auto message = [](const char* text) { return error_of([&] { parse_scene(text, "bad.toml", {}); }); };
  const std::string mesh = "[mesh]\nshape = \"disk\"\nradius = 1\nrings = 1\n";
  const std::string material =
      "[material]\nlambda_ela = 1\nmu_ela = 1\nlambda_vis = 1\nmu_vis = 1\ndensity = 1\n";
  EXPECT_THAT(message("[time]\nduration = 1\n"), HasSubstr("bad.toml:1: [mesh] is missing; needed: "));
  EXPECT_THAT(message(mesh.c_str()), HasSubstr("bad.toml:1: [material] is missing; needed: lambda_ela"));
  EXPECT_THAT(message((mesh + material).c_str()),
              HasSubstr("bad.toml:1: [time] is missing; needed: duration"));
}

struct BadValue {
  std::size_t line;
  const char* text;
  const char* allowed;  // part of the message
};

class BadSceneValue : public ::testing::TestWithParam<BadValue> {};

// file:line: [table] key = value: what is allowed
TEST_P(BadSceneValue, IsNamedWithWhatIsAllowed) {
  const BadValue& bad = GetParam();
  const std::string text = bad.text;
  EXPECT_THAT(refusal_with(bad.line, text),
              AllOf(StartsWith(fmt::format("bad.toml:{}: {}", bad.line, header_above(bad.line))),
                    HasSubstr(key_of(text)), HasSubstr(bad.allowed)))
      << text;
}

TEST(BadScene, AccuracyBesideAStep) {
  EXPECT_THAT(
      refusal_with(46, "step = 1e-3\naccuracy = 1e-6"),
      AllOf(StartsWith("bad.toml:47: [time] accuracy = "), HasSubstr("step = 0.001 decides already")));
}

INSTANTIATE_TEST_SUITE_P(
    WrongType, BadSceneValue,
    ::testing::Values(
        BadValue{1, "title = 7", "title = 7: a text in quotes"},
        BadValue{3, "shape = 7", "shape = 7: \"rectangle\" or \"disk\""},
        BadValue{4, "size = 1.0", "size = 1.0: [x, y], each a finite number > 0 (m)"},
        BadValue{4, "size = [1.0]", "size = [1.0]: [x, y]"},
        BadValue{4, "size = [1.0, \"a\"]", "size = [1.0, \"a\"]: [x, y]"},
        BadValue{5, "nodes = 5", "nodes = 5: two whole numbers"},
        BadValue{5, "nodes = [5, 2.5]", "nodes[1] = 2.5: a whole number"},
        BadValue{5, "nodes = [5, 2, 3]", "two whole numbers"},
        BadValue{6, "diagonal = true", "\"falling\", \"rising\" or \"alternating\""},
        BadValue{7, "thickness = \"thin\"", "thickness = \"thin\": a finite number > 0 (m)"},
        BadValue{9, "grip = 4", "grip = 4: a list of one or more [i, j]"},
        BadValue{9, "grip = [4, 9]", "grip[0] = 4: [i, j] of node numbers from 0 to 9"},
        BadValue{9, "grip = \"right\"", "[i, j]"}, BadValue{9, "grip = [[4, 9, 3]]", "grip[0] = [4, 9, 3]"},
        BadValue{9, "grip = [[4.0, 9.0]]", "grip[0] = [4.0, 9.0]"},
        BadValue{9, "grip = []", "grip = []: a list of one or more"},
        BadValue{11, "lambda_ela = \"7\"", "lambda_ela = \"7\": a finite number >= 0 (Pa)"},
        BadValue{12, "mu_ela = [5.0]", "mu_ela = [5.0]: a finite number >= 0 (Pa)"},
        BadValue{13, "lambda_vis = \"inf\"", "lambda_vis = \"inf\": a number > 0 or inf (Pa s)"},
        BadValue{14, "mu_vis = false", "mu_vis = false: a number > 0 or inf (Pa s)"},
        BadValue{15, "density = 1979-05-27", "density = 1979-05-27: a finite number > 0 (kg/m^3)"},
        BadValue{16, "mass = 1", "\"lumped\" or \"consistent\""},
        BadValue{18, "acceleration = -9.81", "[x, y], each a finite number (m/s^2)"},
        BadValue{20, "edges = 4", "edges = 4: a group's name or [[i, j], ...]"},
        BadValue{21, "axis = 1", "\"both\", \"x\" or \"y\""},
        BadValue{22, "from = \"start\"", "from = \"start\": a finite number >= 0 (s)"},
        BadValue{23, "until = \"end\"", "until = \"end\": a number > 0 or inf (s)"},
        BadValue{25, "nodes = 4", "nodes = 4: a list of node numbers from 0 to 9"},
        BadValue{25, "nodes = [4, 9.0]", "nodes[1] = 9.0: a node number from 0 to 9"},
        BadValue{25, "nodes = []", "nodes = []"},
        BadValue{29, "keys = 3", "keys = 3: a list of one or more [t, ux, uy]"},
        BadValue{29, "keys = []", "keys = []"},
        BadValue{29, "keys = [[0.0, 1.0]]", "keys[0] = [0.0, 1.0]: [t, ux, uy]"},
        BadValue{29, "keys = [[0.0, 0.0, 0.0], [1.0, \"a\", 0.0]]",
                 "keys[1] = [1.0, \"a\", 0.0]: [t, ux, uy]"},
        BadValue{30, "profile = 3", "\"smooth\", \"linear\" or \"hermite\""},
        BadValue{32, "terms = 3", "terms = 3: a list of one or more [node, \"x\" or \"y\", coefficient]"},
        BadValue{32, "terms = []", "terms = []"},
        BadValue{32, "terms = [[9, \"x\"]]", "terms[0] = [9, \"x\"]: [node,"},
        BadValue{32, "terms = [[9, 1, 1.0]]", "terms[0] = [9, 1, 1.0]"},
        BadValue{32, "terms = [[9.5, \"x\", 1.0]]", "terms[0][0] = 9.5: a node number from 0 to 9"},
        BadValue{33, "value = \"0\"", "value = \"0\": a finite number (m)"},
        BadValue{35, "edges = {}", "a group's name"},
        BadValue{36, "vector = 10", "vector = 10: [x, y], each a finite number (Pa)"},
        BadValue{40, "name = 3", "name = 3: a text in quotes"},
        BadValue{43, "duration = \"5 s\"", "duration = \"5 s\": a finite number > 0 (s)"},
        BadValue{44, "frame_rate = \"60\"", "a finite number > 0 (outputs per second)"},
        BadValue{45, "integrator = 4", "integrator = 4: \"rk4\", \"euler\", \"exponential\" or \"implicit\""},
        BadValue{46, "step = \"small\"", "step = \"small\": \"auto\" or a finite number > 0 (s)"},
        BadValue{46, "step = [1]", "\"auto\" or a finite number > 0 (s)"},
        BadValue{46, "accuracy = \"fine\"", "accuracy = \"fine\": a finite number >= 1e-13 and <= 0.1"},
        BadValue{46, "accuracy = 1e-14", "accuracy = 1e-14: a finite number >= 1e-13 and <= 0.1"},
        BadValue{46, "accuracy = 0.2", "accuracy = 0.2: a finite number >= 1e-13 and <= 0.1"},
        BadValue{47, "baumgarte = \"20\"", "a finite number >= 0 (1/s)"},
        BadValue{48, "constraints = 1", "\"auto\" or \"baumgarte\""},
        BadValue{50, "color = 1", "\"w_lambda\", \"w_mu\", \"w\", \"speed\" or \"none\""},
        BadValue{51, "range = 3", "range = 3: \"auto\" or [low, high]"},
        BadValue{51, "range = [1]", "range = [1]"},
        BadValue{53, "every = \"all\"", "every = \"all\": a whole number of outputs"},
        BadValue{53, "every = 2.0", "every = 2.0: a whole number of outputs"},
        BadValue{52, "size = 1280", "size = 1280: [width, height]"},
        BadValue{52, "size = [1280.0, 720]",
                 "size[0] = 1280.0: a whole number of pixels from 240 to 16384"}));

INSTANTIATE_TEST_SUITE_P(
    OutOfRange, BadSceneValue,
    ::testing::Values(
        BadValue{3, "shape = \"rectangel\"", "shape = \"rectangel\": \"rectangle\" or \"disk\""},
        BadValue{4, "size = [1.0, 0.0]", "size = [1.0, 0.0]"}, BadValue{4, "size = [-1.0, 1.0]", "> 0"},
        BadValue{5, "nodes = [1, 2]", "nodes[0] = 1: a whole number from 2"},
        BadValue{5, "nodes = [5, -2]", "nodes[1] = -2"},
        BadValue{5, "nodes = [5, 9223372036854775807]", "nodes[1] = 9223372036854775807"},
        BadValue{5, "nodes = [1000000, 1000000]", "1e+12 nodes need about 1.4e+05 GB"},
        BadValue{6, "diagonal = \"left\"", "\"falling\""},
        BadValue{7, "thickness = 0", "thickness = 0: a finite number > 0"},
        BadValue{7, "thickness = -1.5", "thickness = -1.5"},
        BadValue{7, "thickness = 1e-320", "thickness = 1e-320: 1e-30 to 1e+30 is allowed (m)"},
        BadValue{9, "grip = [[4, 10]]", "grip[0] = [4, 10]: [i, j] of node numbers from 0 to 9"},
        BadValue{9, "grip = [[4, 9], [0, 9]]", "grip[1] = [0, 9]: two nodes joined by an edge of the mesh"},
        BadValue{9, "grip = [[4, 9], [9, 4]]", "grip[1] = [9, 4]: the edge is in the list already"},
        BadValue{9, "left = [[4, 9]]", "left = [[4, 9]]: the mesh has a group of this name already"},
        BadValue{9, "boundary = [[4, 9]]", "already"},
        BadValue{4, "size = [1e-200, 1.0]", "size = [1e-200, 1.0]: 1e-30 to 1e+30 is allowed (m)"},
        BadValue{11, "lambda_ela = 1e-200", "1e-30 to 1e+30 is allowed (Pa), and 0"},
        BadValue{13, "lambda_vis = 1e300", "1e-30 to 1e+30 is allowed (Pa s), and inf"},
        BadValue{15, "density = 1e-300", "density = 1e-300: 1e-30 to 1e+30 is allowed (kg/m^3)"},
        BadValue{18, "acceleration = [0.0, 1e200]", "at most 1e+30"},
        BadValue{36, "vector = [1e200, 0.0]", "at most 1e+30"},
        BadValue{43, "duration = 1e-300", "1e-30 to 1e+30 is allowed (s)"},
        BadValue{11, "lambda_ela = -7", "lambda_ela = -7: a finite number >= 0"},
        BadValue{12, "mu_ela = -1e-9", "mu_ela = -1e-09"},
        BadValue{13, "lambda_vis = 0", "lambda_vis = 0: a number > 0"},
        BadValue{14, "mu_vis = -2.0", "mu_vis = -2.0"}, BadValue{14, "mu_vis = 1e-320", "mu_vis"},
        BadValue{15, "density = 0.0", "density = 0.0: a finite number > 0"},
        BadValue{16, "mass = \"heavy\"", "\"heavy\""},
        BadValue{20, "edges = \"lefft\"",
                 "did you mean \"left\"? the groups are \"bottom\", \"boundary\", \"grip\", \"left\", "
                 "\"right\" and \"top\""},
        BadValue{20, "edges = [[0, 10]]", "edges[0] = [0, 10]"},
        BadValue{20, "edges = [[0, 9]]", "joined by an edge of the mesh"},
        BadValue{21, "axis = \"z\"", "axis = \"z\""},
        BadValue{22, "from = -1", "from = -1: a finite number >= 0 (s)"},
        BadValue{23, "until = 0", "until = 0: a number > 0"},
        BadValue{25, "nodes = [4, 10]", "nodes[1] = 10: a node number from 0 to 9"},
        BadValue{25, "nodes = [4, -1]", "nodes[1] = -1"}, BadValue{25, "nodes = [4, 4]", "node 4 twice"},
        BadValue{25, "nodes = [99999999999]", "nodes[0] = 99999999999"},
        BadValue{28, "until = 0.5", "until = 0.5: a number > 1"},
        BadValue{29, "keys = [[1.0, 0.0, 0.0], [1.0, 0.5, 0.0]]",
                 "keys[1] = [1.0, 0.5, 0.0]: times must rise; t = 1 is not after t = 1"},
        BadValue{32, "terms = [[10, \"x\", 1.0]]", "terms[0][0] = 10: a node number from 0 to 9"},
        BadValue{32, "terms = [[9, \"z\", 1.0]]", "terms[0]"},
        BadValue{32, "terms = [[9, \"x\", 0]]",
                 "terms[0] = [9, \"x\", 0]: a finite coefficient other than 0"},
        BadValue{35, "edges = \"side\"", "no such group"}, BadValue{38, "until = -1", "until = -1"},
        BadValue{40, "name = \"\"", "name = \"\": one or more of A-Z"},
        BadValue{40, "name = \"my grip\"", "name = \"my grip\""},
        BadValue{40, "name = \"gr\\u00fcn\"", "one or more of A-Z"},
        BadValue{43, "duration = 0", "duration = 0: a finite number > 0 (s)"},
        BadValue{43, "duration = -5.0", "duration = -5.0"}, BadValue{44, "frame_rate = 0", "frame_rate = 0"},
        BadValue{44, "frame_rate = 1e9",
                 "5e+09 outputs in 5 s, 1.5e+03 GB of memory for their names alone; at most 1e+07"},
        BadValue{45, "integrator = \"rk45\"",
                 "integrator = \"rk45\": \"rk4\", \"euler\", \"exponential\" or \"implicit\""},
        BadValue{46, "step = 0", "step = 0: \"auto\""}, BadValue{46, "step = -0.1", "step = -0.1"},
        BadValue{46, "step = 1e-300", "5e+300 steps in 5 s; at most 1e+12"},
        BadValue{47, "baumgarte = -1", "baumgarte = -1: a finite number >= 0 (1/s)"},
        BadValue{48, "constraints = \"none\"", "constraints = \"none\""},
        BadValue{50, "color = \"red\"", "color = \"red\""},
        BadValue{51, "range = [2.0, 1.0]", "range = [2, 1]: \"auto\" or two finite numbers"},
        BadValue{51, "range = \"full\"", "range = \"full\""},
        BadValue{53, "every = 0", "every = 0: a whole number of outputs"},
        BadValue{53, "every = -3", "from 1 to 1000000000"},
        BadValue{53, "every = 1000000001", "from 1 to 1000000000"},
        BadValue{52, "size = [239, 720]", "size[0] = 239: a whole number of pixels from 240 to 16384"},
        BadValue{52, "size = [1280, 159]", "size[1] = 159: a whole number of pixels from 160 to 16384"},
        BadValue{52, "size = [100000, 100000]",
                 "size = [100000, 100000]: about 480 GB of memory; a width of 240 to 16384"}));

INSTANTIATE_TEST_SUITE_P(
    NonFinite, BadSceneValue,
    ::testing::Values(
        BadValue{4, "size = [inf, 1.0]", "size = [inf, 1.0]"},
        BadValue{4, "size = [nan, 1.0]", "size = [nan, 1.0]"},
        BadValue{7, "thickness = inf", "thickness = inf"},
        BadValue{11, "lambda_ela = inf", "lambda_ela = inf: a finite"},
        BadValue{11, "lambda_ela = nan", "lambda_ela = nan"}, BadValue{12, "mu_ela = -inf", "mu_ela = -inf"},
        BadValue{13, "lambda_vis = nan", "lambda_vis = nan"}, BadValue{14, "mu_vis = -inf", "mu_vis = -inf"},
        BadValue{15, "density = inf", "density = inf"},
        BadValue{18, "acceleration = [0.0, nan]", "[0.0, nan]"},
        BadValue{18, "acceleration = [inf, 0]", "[inf, 0]"}, BadValue{22, "from = inf", "from = inf"},
        BadValue{22, "from = nan", "from = nan"}, BadValue{23, "until = nan", "until = nan"},
        BadValue{29, "keys = [[0.0, inf, 0.0]]", "keys[0] = [0.0, inf, 0.0]"},
        BadValue{29, "keys = [[nan, 0.0, 0.0]]", "keys[0] = [nan, 0.0, 0.0]"},
        BadValue{32, "terms = [[9, \"x\", inf]]", "terms[0] = [9, \"x\", inf]"},
        BadValue{33, "value = nan", "value = nan"},
        BadValue{36, "vector = [inf, 0.0]", "vector = [inf, 0.0]"},
        BadValue{43, "duration = inf", "duration = inf"}, BadValue{43, "duration = nan", "duration = nan"},
        BadValue{44, "frame_rate = inf", "frame_rate = inf"}, BadValue{46, "step = inf", "step = inf"},
        BadValue{46, "step = nan", "step = nan"}, BadValue{47, "baumgarte = inf", "baumgarte = inf"},
        BadValue{51, "range = [0, inf]", "range = [0, inf]"}));

TEST(BadScene, OneOfSeveralKeysOnly) {
  EXPECT_THAT(refusal_with(6, "file = \"a.msh\""),
              AllOf(StartsWith("bad.toml:6: [mesh] file = \"a.msh\": shape is there too"),
                    HasSubstr("exactly one of shape, file, points")));
  EXPECT_THAT(refusal_with(6, "radius = 1.0"),
              StartsWith("bad.toml:6: [mesh] radius = 1.0: goes with shape = \"disk\" only"));
  EXPECT_THAT(refusal_with(3, "shape = \"disk\""),
              StartsWith("bad.toml:4: [mesh] size = [1.0, 0.25]: goes with"));
  EXPECT_THAT(refusal_with(6, "triangles = [[0, 1, 2]]"), StartsWith("bad.toml:6: [mesh] triangles"));
  EXPECT_THAT(refusal_with(21, "nodes = [1]"),
              StartsWith("bad.toml:21: [[fix]] nodes = [1]: edges is there too"));
  EXPECT_THAT(refusal_with(37, "keys = [[0, 0, 0]]"), StartsWith("bad.toml:37: [[traction]] keys"));
}

TEST(BadScene, DisksAndInlineMeshes) {
  const auto message = [](const std::string& mesh) {
    return error_of([&] {
      parse_scene("[mesh]\n" + mesh +
                      "[material]\nlambda_ela = 1\nmu_ela = 1\nlambda_vis = 1\nmu_vis = 1\ndensity = "
                      "1\n[time]\nduration = 1\n",
                  "bad.toml", RHEO_TEST_DATA);
    });
  };
  const std::string disk = "shape = \"disk\"\n";
  EXPECT_THAT(message(disk + "radius = 1\n"), HasSubstr("[mesh] rings is missing"));
  EXPECT_THAT(message(disk + "rings = 1\n"), HasSubstr("[mesh] radius is missing"));
  EXPECT_THAT(message(disk + "radius = 0\nrings = 1\n"),
              HasSubstr("bad.toml:3: [mesh] radius = 0: a finite number > 0"));
  EXPECT_THAT(message(disk + "radius = nan\nrings = 1\n"), HasSubstr("radius = nan"));
  EXPECT_THAT(message(disk + "radius = 1\nrings = 0\n"),
              HasSubstr("bad.toml:4: [mesh] rings = 0: a whole number from 1"));
  EXPECT_THAT(message(disk + "radius = 1\nrings = 1.5\n"), HasSubstr("rings = 1.5"));
  EXPECT_THAT(message(disk + "radius = 1\nrings = 1000000\n"), HasSubstr("3e+12 nodes"));

  const std::string points = "points = [[0, 0], [1, 0],\n  [0, 1], [1, 1]]\n";
  EXPECT_THAT(message(points), HasSubstr("[mesh] triangles is missing"));
  EXPECT_THAT(message("triangles = [[0, 1, 2]]\n"), HasSubstr("shape or file or points is missing"));
  EXPECT_THAT(message(points + "triangles = [[0, 1, 4]]\n"),
              HasSubstr("bad.toml:4: [mesh] triangles[0] = [0, 1, 4]"));
  EXPECT_THAT(message(points + "triangles = [[0, 1, 2]]\n"),
              HasSubstr("node 3 at (1, 1) belongs to no triangle"));
  EXPECT_THAT(
      message(points + "triangles = [[0, 1, 1], [1, 2, 3]]\n"),
      AllOf(StartsWith("bad.toml:4: [mesh] triangles = "), HasSubstr("triangle 0 (0, 1, 1): node 1 twice")));
  EXPECT_THAT(message("points = [[0, 0], [1, nan], [0, 1]]\ntriangles = [[0, 1, 2]]\n"),
              HasSubstr("bad.toml:2: [mesh] points[1] = [1, nan]"));
  EXPECT_THAT(message("points = 3\ntriangles = [[0, 1, 2]]\n"), HasSubstr("points = 3"));

  EXPECT_THAT(message("file = 3\n"), HasSubstr("file = 3: a text in quotes"));
  EXPECT_THAT(message("file = \"\"\n"), HasSubstr("Gmsh"));
  EXPECT_THAT(message("file = \"msh/plate.stl\"\n"),
              AllOf(StartsWith("bad.toml:2: [mesh] file = "), HasSubstr("plate.stl:1:")));
  EXPECT_THAT(
      error_of([] { parse_scene("[mesh]\nfile = \"none.msh\"\n", "bad.toml", {}); }, Error::Kind::file),
      AllOf(StartsWith("bad.toml:2: "), HasSubstr("No such file")));
}

TEST(BadScene, TablesOfKeysInFiles) {
  const auto folder = testing::fresh_folder("bad_keys");
  auto lines = all_keys();
  lines[28] = "keys = \"keys.csv\"";
  const auto message = [&](const std::string& csv) {
    testing::write_text(folder / "keys.csv", csv);
    return error_of([&] { parse_scene(fmt::format("{}\n", fmt::join(lines, "\n")), "bad.toml", folder); });
  };
  EXPECT_THAT(message("0,0\n"),
              AllOf(StartsWith("bad.toml:29: [[move]] keys = \"keys.csv\": "), HasSubstr("keys.csv:1:"),
                    HasSubstr("3 numbers are needed (t, ux, uy")));
  EXPECT_THAT(message("0,0,0\n1,2,three\n"), AllOf(HasSubstr("keys.csv:2:"), HasSubstr("\"three\"")));
  EXPECT_THAT(message("0,0,0\n0,0,0\n"), AllOf(HasSubstr("keys.csv:2:"), HasSubstr("times must rise")));
  lines[28] = "keys = \"none.csv\"";
  EXPECT_THAT(
      error_of([&] { parse_scene(fmt::format("{}\n", fmt::join(lines, "\n")), "bad.toml", folder); },
               Error::Kind::file),
      AllOf(StartsWith("bad.toml:29: [[move]] keys"), HasSubstr("none.csv"), HasSubstr("No such file")));
}

TEST(BadScene, TwoProbesOfOneName) {
  auto lines = all_keys();
  lines.insert(lines.begin() + 41, {"[[probe]]", "name = \"grip\"", "edges = \"left\""});
  EXPECT_THAT(error_of([&] { parse_lines(lines); }),
              AllOf(StartsWith("bad.toml:42: [[probe]] name = \"grip\""), HasSubstr("taken")));
}

TEST(BadScene, HermiteKeysHaveVelocities) {
  EXPECT_THAT(
      refusal_with(30, "profile = \"hermite\""),
      StartsWith("bad.toml:29: [[move]] keys[0] = [0.0, 0.0, 0.0]: [t, ux, uy, vx, vy] of finite numbers"));
}

TEST(BadScene, OneNodeTwiceInAConstraint) {
  EXPECT_THAT(refusal_with(32, "terms = [[9, \"x\", 1.0], [9, \"x\", 2.0]]"),
              AllOf(StartsWith("bad.toml:31: [[constraint]] "), HasSubstr("node 9 twice along x")));
}

TEST(BadScene, SingleAndDoubleBrackets) {
  EXPECT_THAT(refusal_with(19, "[fix]"), AllOf(StartsWith("bad.toml:19: "), HasSubstr("write [[fix]]")));
  EXPECT_THAT(refusal_with(10, "[[material]]"), AllOf(StartsWith("bad.toml:10: "), HasSubstr("[material]")));
  EXPECT_THAT(refusal_with(1, "fix = 3\n"), HasSubstr("bad.toml:"));
  EXPECT_THAT(refusal_with(1, "render = 3"), HasSubstr("bad.toml:"));
}

TEST(BadScene, TextsThatAreNoScene) {
  const auto message = [](const std::string& text) {
    return error_of([&] { parse_scene(text, "bad.toml", {}); });
  };
  EXPECT_THAT(message(""), HasSubstr("bad.toml:1: the scene is empty"));
  EXPECT_THAT(message("# nothing but a comment\n\n"), HasSubstr("empty"));
  EXPECT_THAT(message(std::string("title = \"a\"\n\0\1\2", 15)), HasSubstr("bad.toml:2: a zero byte"));
  EXPECT_THAT(message("\x89PNG\r\n\x1a\n"), HasSubstr("bad.toml:1: not valid TOML"));
  EXPECT_THAT(message("[mesh]\nsize = [1, \n"), HasSubstr("not valid TOML"));
  EXPECT_THAT(message("[mesh]\nshape = rectangle\n"), HasSubstr("bad.toml:2: not valid TOML"));
  EXPECT_THAT(message("[mesh]\nfile = \"a\"\nfile = \"b\"\n"), HasSubstr("bad.toml:3: not valid TOML"));
}

TEST(BadScene, CharactersBeyondAsciiBelongInQuotesAndComments) {
  for (const char* letter : {"\xC3\xA9", "\xEF\xAD\x90", "\xE2\x80\xA8", "\xFF"}) {
    EXPECT_THAT(refusal_with(15, std::string("d") + letter + "nsity = 1"),
                AllOf(StartsWith("bad.toml:15: not valid TOML: "), HasSubstr("beyond ASCII")));
  }
  auto lines = all_keys();
  lines[0] = "title = \"\"\"\n\\\"\xC3\xA9\"\"\"\"  # \xC3\xA9";
  EXPECT_EQ(parse_lines(lines).title, "\"\xC3\xA9\"");
  lines[0] = "title = \"\"\"a \\\n \xC3\xA9\"\"\"";
  EXPECT_EQ(parse_lines(lines).title, "a \xC3\xA9");
  lines[0] = "title = '\\\xC3\xA9'";
  EXPECT_EQ(parse_lines(lines).title, "\\\xC3\xA9");
}

TEST(BadScene, DeepNestingIsRefused) {
  const auto message = [](const std::string& text) {
    return error_of([&] { parse_scene(text, "bad.toml", {}); });
  };
  std::string dotted = "a";
  for (int i = 0; i < 1'000'000; ++i) dotted += ".a";
  EXPECT_THAT(message(dotted + " = 1\n"), HasSubstr("bad.toml:1: a key of more than 32 parts"));
  EXPECT_THAT(message("[" + dotted + "]\n"), HasSubstr("bad.toml:1: a key of more than 32 parts"));
  EXPECT_THAT(message("a = " + std::string(1'000'000, '[')), HasSubstr("bad.toml:1: brackets nested"));
  std::string braces;
  for (int i = 0; i < 100'000; ++i) braces += "{a=";
  EXPECT_THAT(message("a = " + braces), HasSubstr("bad.toml:1: brackets nested more than 32 deep"));
  // Both at once, each as deep as it may be.
  std::string both = "\n", key = "k";
  for (int i = 1; i < 32; ++i) key += ".k";
  for (int i = 0; i < 31; ++i) both = "{" + key + " = " + (i == 0 ? "1" : both) + "}";
  EXPECT_THAT(message("[" + key + "]\n" + key + " = " + both + "\n"), HasSubstr("unknown key"));
}

TEST(BadScene, MessagesStayShortAndOnOneLine) {
  const std::string message = refusal_with(20, "edges = \"" + std::string(100'000, 'x') + "\\n\\u0007\"");
  EXPECT_LT(message.size(), 400u);
  EXPECT_THAT(refusal_with(16, "\"a\\nb\" = 3"), HasSubstr("a\\x0Ab = 3"));
}

}  // namespace
}  // namespace rheo
