// [material] of a scene file: the ways to give it and what each comes to.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io_error_of.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/relaxation.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using testing::write_text;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-13;

// A scene whose material begins at line 5 with density = 2 (line 6).
std::string scene_of(const std::string& material) {
  return "[mesh]\nshape = \"rectangle\"\nsize = [1, 1]\nnodes = [2, 2]\n[material]\ndensity = 2\n" +
         material + "\n[time]\nduration = 1\n";
}

Scene read(const std::string& material, const std::filesystem::path& folder = {}) {
  return parse_scene(scene_of(material), "m.toml", folder);
}

std::string refusal(const std::string& material, const std::filesystem::path& folder = {},
                    Error::Kind kind = Error::Kind::input) {
  return error_of([&] { read(material, folder); }, kind);
}

void expect_branch(const MaxwellBranch& b, double lambda_ela, double mu_ela, double lambda_vis,
                   double mu_vis) {
  EXPECT_DOUBLE_EQ(b.lambda_ela, lambda_ela);
  EXPECT_DOUBLE_EQ(b.mu_ela, mu_ela);
  EXPECT_DOUBLE_EQ(b.lambda_vis, lambda_vis);
  EXPECT_DOUBLE_EQ(b.mu_vis, mu_vis);
}

const std::string simple = "lambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2\n";

TEST(MaterialReader, TakesTheSimpleKeys) {
  const Scene scene = read(simple);
  EXPECT_EQ(scene.material.branch_count(), 1u);
  expect_branch(scene.material.branch(0), 7, 5, 4, 2);
  EXPECT_EQ(scene.material.density, 2.0);
  EXPECT_EQ(scene.origin.preset, "");
  EXPECT_THAT(scene.origin.conversions, IsEmpty());
  EXPECT_FALSE(scene.origin.measured);
}

TEST(MaterialReader, AddsBranchesAnElasticAndAViscousPart) {
  const Material m = read(simple +
                          "[material.elastic]\nlambda = 3\nmu = 1\n"
                          "[material.viscous]\nlambda = 0.5\nmu = 0\n"
                          "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 2\nlambda_vis = 3\nmu_vis = inf\n"
                          "[[material.maxwell]]\nlambda_ela = 10\nmu_ela = 0\ntime = 0.5\n")
                         .material;
  ASSERT_EQ(m.branch_count(), 3u);
  expect_branch(m.branch(0), 7, 5, 4, 2);
  expect_branch(m.branch(1), 1, 2, 3, infinite);
  expect_branch(m.branch(2), 10, 0, 5, infinite);
  EXPECT_EQ(m.elastic.lambda, 3.0);
  EXPECT_EQ(m.elastic.mu, 1.0);
  EXPECT_EQ(m.viscous.lambda, 0.5);
  EXPECT_EQ(m.viscous.mu, 0.0);
}

TEST(MaterialReader, NeedsTheSimpleKeysWhereNothingElseIsGivenOnly) {
  EXPECT_THAT(refusal(""), StartsWith("m.toml:5: [material] lambda_ela is missing: "));
  const Material elastic = read("[material.elastic]\nlambda = 3\nmu = 1\n").material;
  EXPECT_EQ(elastic.branch_count(), 1u);
  expect_branch(elastic.branch(0), 0, 0, infinite, infinite);
  const Material branch =
      read("maxwell = [{lambda_ela = 1, mu_ela = 2, lambda_vis = 3, mu_vis = 4}]").material;
  EXPECT_EQ(branch.branch_count(), 1u);  // the first of them is the first four numbers
  expect_branch(branch.branch(0), 1, 2, 3, 4);
  EXPECT_THAT(refusal("mu_ela = 5\n[material.elastic]\nlambda = 3\nmu = 1\n"),
              StartsWith("m.toml:5: [material] lambda_ela is missing"));
}

TEST(MaterialReader, TakesYoungsModulusAndPoissonsRatio) {
  const Scene scene = read(
      "young_ela = 1000\nyoung_vis = 200\npoisson = 0.25\n"
      "[material.elastic]\nyoung = 50\npoisson = 0.4\n"
      "[material.viscous]\nyoung = 3\n"
      "[[material.maxwell]]\nyoung_ela = 10\ntime = 5\n");
  const auto lambda = [](double e, double nu) { return e * nu / ((1 + nu) * (1 - 2 * nu)); };
  const auto mu = [](double e, double nu) { return e / (2 * (1 + nu)); };
  const Material& m = scene.material;
  EXPECT_NEAR(m.lambda_ela, lambda(1000, 0.25), 1000 * rounding);
  EXPECT_NEAR(m.mu_ela, mu(1000, 0.25), 1000 * rounding);
  EXPECT_NEAR(m.lambda_vis, lambda(200, 0.25), 1000 * rounding);
  EXPECT_NEAR(m.mu_vis, mu(200, 0.25), 1000 * rounding);
  EXPECT_NEAR(m.elastic.lambda, lambda(50, 0.4), 1000 * rounding);
  EXPECT_NEAR(m.elastic.mu, mu(50, 0.4), 1000 * rounding);
  EXPECT_NEAR(m.viscous.lambda, lambda(3, 0.25), 1000 * rounding);
  EXPECT_NEAR(m.branch(1).mu_vis, 5 * mu(10, 0.25), 1000 * rounding);
  ASSERT_EQ(scene.origin.conversions.size(), 5u);
  const MaterialConversion& first = scene.origin.conversions[0];
  EXPECT_EQ(first.name, "[material] young_ela");
  EXPECT_EQ(first.given.young, 1000.0);
  EXPECT_EQ(first.given.poisson, 0.25);
  EXPECT_EQ(first.moduli.mu, m.mu_ela);
  EXPECT_STREQ(scene.origin.conversions[1].unit, "Pa s");
}

TEST(MaterialReader, ConvertsUnderPlaneStressWhereAsked) {
  const Material m = read("young_ela = 1000\nyoung_vis = inf\npoisson = 0.5\nplane = \"stress\"").material;
  EXPECT_NEAR(m.lambda_ela, 1000 * 0.5 / 0.75, 1000 * rounding);
  EXPECT_NEAR(m.mu_ela, 1000 / 3.0, 1000 * rounding);
  EXPECT_EQ(m.lambda_vis, infinite);
  EXPECT_THAT(refusal("young_ela = 1\nyoung_vis = 1\npoisson = 0.3\nplane = \"stress\"\n"
                      "[material.elastic]\nyoung = 1\npoisson = 0.4\n"),
              StartsWith("m.toml:13: [material.elastic] poisson = 0.4: under plane = \"stress\" one ratio"));
}

TEST(MaterialReader, HasNoLambdaAtPoissonsRatioZero) {
  const Material m = read("young_ela = 10\nyoung_vis = 4\npoisson = 0").material;
  expect_branch(m.branch(0), 0, 5, infinite, 2);
  EXPECT_THAT(refusal("lambda_ela = 7\nmu_ela = 5\nyoung_vis = 4\npoisson = 0"),
              AllOf(StartsWith("m.toml:9: [material] young_vis = 4: gives lambda_vis = 0"),
                    HasSubstr("give lambda_vis and mu_vis")));
  const Material burgers = read(
                               "preset = \"burgers_equivalent\"\nyoung_ela_1 = 10\nyoung_vis_1 = 4\n"
                               "young_ela_2 = 20\nyoung_vis_2 = 2\npoisson = 0")
                               .material;
  EXPECT_EQ(relaxation(burgers, 0.0).lambda, 0.0);
  EXPECT_NEAR(relaxation(burgers, 0.0).mu, 5.0, rounding * 5);
  EXPECT_THAT(refusal("preset = \"maxwell\"\nlambda_ela = 7\nmu_ela = 5\nyoung_vis = 4\npoisson = 0"),
              StartsWith("m.toml:10: [material] young_vis = 4: gives lambda_vis = 0"));
}

TEST(MaterialReader, ExpandsPresets) {
  const Scene zener = read(
      "preset = \"zener\"\nlambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2\n"
      "young_elastic = 30\npoisson = 0.25\n");
  EXPECT_EQ(zener.origin.preset, "zener");
  expect_branch(zener.material.branch(0), 7, 5, 4, 2);
  EXPECT_NEAR(zener.material.elastic.lambda, 12.0, 12 * rounding);
  EXPECT_NEAR(zener.material.elastic.mu, 12.0, 12 * rounding);
  EXPECT_EQ(zener.material.density, 2.0);
  const Material five = read(
                            "preset = \"five_element\"\nlambda_ela_1 = 1\nmu_ela_1 = 2\nlambda_vis_1 = 3\n"
                            "mu_vis_1 = 4\nlambda_ela_2 = 5\nmu_ela_2 = 6\nlambda_vis_2 = 7\nmu_vis_2 = 8\n"
                            "lambda_viscous = 9\nmu_viscous = 10")
                            .material;
  expect_branch(five.branch(0), 1, 2, 3, 4);
  expect_branch(five.branch(1), 5, 6, 7, 8);
  EXPECT_EQ(five.viscous.mu, 10.0);
  const Material plastic = read("preset = \"plastic\"\nlambda_viscous = 9\nmu_viscous = 10").material;
  EXPECT_EQ(plastic.viscous.lambda, 9.0);
  EXPECT_EQ(relaxation(plastic, 0.0).mu, 0.0);
}

TEST(MaterialReader, RefusesWhatAPresetHasNoUseFor) {
  EXPECT_THAT(refusal("preset = \"zenner\""),
              AllOf(StartsWith("m.toml:7: [material] preset = \"zenner\": did you mean \"zener\"?"),
                    HasSubstr("\"kelvin_voigt\"")));
  EXPECT_THAT(refusal("preset = 3"), HasSubstr("preset = 3: a text in quotes"));
  // Whatever stands beside it, and before it.
  EXPECT_THAT(refusal("lambda_elastic = 4\nyoung_ela_1 = 3\npreset = \"Zenner\""),
              HasSubstr("preset = \"Zenner\": did you mean \"zener\"?"));
  EXPECT_THAT(refusal("lambda_elastic = 4\npreset = 3"), HasSubstr("preset = 3: a text in quotes"));
  EXPECT_EQ(
      read(
          "preset = \"kelvin-voigt\"\nlambda_elastic = 4\nmu_elastic = 4\nlambda_viscous = 1\nmu_viscous = 1")
          .origin.preset,
      "kelvin_voigt");
  EXPECT_THAT(
      refusal("preset = \"zener\"\nlambda_ela = 1\nmu_ela = 1\nlambda_vis = 1\nmu_vis = 1"),
      HasSubstr("[material] lambda_elastic is missing: elastic of zener, (ela - vis) | elastic, by lambda"));
  EXPECT_THAT(refusal("preset = \"zener\"\nlambda_ela_1 = 1"),
              HasSubstr("lambda_ela_1 = 1: unknown key; did you mean lambda_ela?"));
  EXPECT_THAT(refusal("preset = \"elastic\"\nlambda_elastic = 1\nmu_elastic = 1\n[material.viscous]\nmu = 1"),
              AllOf(StartsWith("m.toml:10: [material] viscous = "),
                    HasSubstr("preset = \"elastic\" gives the whole material; leave out one of the two")));
  EXPECT_THAT(refusal("preset = \"elastic\"\nlambda_elastic = -1\nmu_elastic = 1"),
              StartsWith("m.toml:8: [material] lambda_elastic = -1: a finite number >= 0 (Pa) is needed"));
  EXPECT_THAT(refusal("preset = \"burgers_equivalent\"\nyoung_ela_1 = 10\nyoung_vis_1 = inf\n"
                      "young_ela_2 = 20\nyoung_vis_2 = 2\npoisson = 0.1"),
              StartsWith("m.toml:9: [material] young_vis_1 = inf: a finite number > 0 (Pa s)"));
}

TEST(MaterialReader, NamesEveryOtherMistake) {
  const auto expect = [](const std::string& material, int line, const std::string& text) {
    EXPECT_THAT(refusal(material), AllOf(StartsWith(fmt::format("m.toml:{}: ", line)), HasSubstr(text)));
  };
  expect("young_ela = 1\nyoung_vis = 1\n", 7,
         "[material] young_ela = 1: poisson, Poisson's ratio, is needed");
  expect("young_ela = 1\nmu_ela = 1\npoisson = 0.3", 8, "mu_ela = 1: young_ela is there too");
  expect("young_ela = -1\npoisson = 0.3", 7, "young_ela = -1: a finite number >= 0 (Pa)");
  expect("young_ela = 1\nyoung_vis = 0\npoisson = 0.3", 8, "young_vis = 0: a number > 0 or inf (Pa s)");
  expect("young_ela = 1\nyoung_vis = 1\npoisson = 0.5", 9,
         "poisson = 0.5: a number >= 0 and < 0.5 is needed");
  expect("young_ela = 1\nyoung_vis = 1\npoisson = -0.1", 9, "poisson = -0.1: ");
  expect("young_ela = 1\nyoung_vis = 1\npoisson = nan", 9, "poisson = nan: ");
  expect("young_ela = 1\nyoung_vis = 1\npoisson = \"0.3\"", 9, "poisson = \"0.3\": ");
  expect("young_ela = 1\nplane = \"stress\"\npoisson = 0.6", 9, "a number >= 0 and <= 0.5 is needed");
  expect("young_ela = 1e30\nyoung_vis = 1\npoisson = 0.499999", 7, "gives lambda_ela = ");
  expect(simple + "plane = \"flat\"", 11, "plane = \"flat\": \"strain\" or \"stress\" is allowed");
  expect(simple + "poisson = 0.3", 11, "goes with a young key or measured data only");
  expect(simple + "plane = \"stress\"", 11, "goes with a young key or measured data only");
  expect(simple + "terms = 3", 11, "goes with relaxation or frequency only");
  expect(simple + "modulus = \"shear\"", 11, "goes with relaxation or frequency only");
  expect(simple + "weights = \"absolute\"", 11, "goes with relaxation or frequency only");
  expect(simple + "elastic = 3", 11, "a table is needed");
  expect(simple + "[[material.elastic]]\nlambda = 1\nmu = 1", 11, "one table, [material.elastic], is needed");
  expect(simple + "[material.maxwell]\nlambda_ela = 1", 11, "write [[material.maxwell]]");
  expect(simple + "maxwell = [1]", 11, "write [[material.maxwell]]");
  expect(simple + "[material.elastic]\nlambda = 1", 11,
         "[material.elastic] mu is missing: the elastic modulus by mu");
  expect(simple + "[material.elastic]\nlambda = 1\nmu = 1\npoisson = 0.3", 14,
         "[material.elastic] poisson = 0.3: goes with a young key only");
  expect(simple + "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 1\ntime = 1\npoisson = 0.3", 15,
         "[[material.maxwell]] poisson = 0.3: goes with a young key only");
  expect(simple + "[material.elastic]\nlambda = 1\nmu = -1", 13, "[material.elastic] mu = -1: ");
  expect(simple + "[material.elastic]\nlambda = 1\nmu = inf", 13, "[material.elastic] mu = inf: a finite");
  expect(simple + "[material.elastic]\nlambda_ela = 1", 12, "[material.elastic] lambda_ela = 1: unknown key");
  expect(simple + "[material.viscous]\nlambda = 1\nmu = inf", 13,
         "[material.viscous] mu = inf: a finite number >= 0 (Pa s)");
  expect(simple + "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 1\nlambda_vis = 0\nmu_vis = 1", 14,
         "[[material.maxwell]] lambda_vis = 0: a number > 0");
  expect(simple + "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 1\nmu_vis = 1\ntime = 1", 14,
         "[[material.maxwell]] mu_vis = 1: time is there too");
  expect(simple + "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 1\ntime = 0", 14,
         "time = 0: a finite number > 0 (s)");
  expect(simple + "[[material.maxwell]]\nlambda_ela = 1e20\nmu_ela = 1\ntime = 1e20", 14,
         "gives a viscosity of 1e+40");
  expect(simple + "[[material.maxwell]]\nlambda_ella = 1", 12, "did you mean lambda_ela?");
  expect(simple + "relaxation = \"a.csv\"", 7,
         "lambda_ela = 7: relaxation = \"a.csv\" gives the whole material");
  expect("frequency = \"a.csv\"\nrelaxation = \"a.csv\"", 7,
         "frequency = \"a.csv\": relaxation = \"a.csv\" gives");
}

class MeasuredMaterialReader : public ::testing::Test {
 protected:
  // E(t) = 100 exp(-t / 2) + 20 or its moduli over frequency.
  void SetUp() override {
    folder_ = fresh_folder("measured_material");
    std::string relaxation = "time,modulus\n", sweep = "# Hz, Pa, Pa\n";
    for (int i = 0; i < 40; ++i) {
      const double t = 0.05 * std::pow(10.0, i / 15.0);
      relaxation += fmt::format("{:.17g},{:.17g}\n", t, 100.0 * std::exp(-t / 2.0) + 20.0);
      const double y = 2.0 * 2.0 * 3.14159265358979323846 * t;
      sweep += fmt::format("{:.17g},{:.17g},{:.17g}\n", t, 20.0 + 100.0 * y * y / (1.0 + y * y),
                           100.0 * y / (1.0 + y * y));
    }
    write_text(folder_ / "relaxation.csv", relaxation);
    write_text(folder_ / "sweep.csv", sweep);
  }
  std::filesystem::path folder_;
};

TEST_F(MeasuredMaterialReader, BecomesBranchesOfOnePoissonsRatio) {
  for (const std::string data : {"relaxation = \"relaxation.csv\"", "frequency = \"sweep.csv\""}) {
    const Scene scene = read(data + "\npoisson = 0.25", folder_);
    const Material& m = scene.material;
    ASSERT_EQ(m.branch_count(), 1u) << data;
    const double tolerance = 1e-8;                    // of the fit of exact data
    EXPECT_NEAR(m.lambda_ela, 40.0, 40 * tolerance);  // E nu / ((1 + nu) (1 - 2 nu)) = 0.4 E
    EXPECT_NEAR(m.mu_ela, 40.0, 40 * tolerance);
    EXPECT_NEAR(m.lambda_vis, 80.0, 80 * tolerance);
    EXPECT_NEAR(m.elastic.mu, 8.0, 8 * tolerance);
    EXPECT_EQ(m.viscous.mu, 0.0);
    ASSERT_TRUE(scene.origin.measured);
    EXPECT_LT(scene.origin.measured->fit.rms, tolerance);
    EXPECT_EQ(scene.origin.measured->relaxation.size() + scene.origin.measured->sweep.size(), 40u);
    EXPECT_EQ(scene.files.size(), 1u);
    EXPECT_THAT(scene.notes, IsEmpty());
  }
}

TEST_F(MeasuredMaterialReader, OfAShearModulusIsMu) {
  const Material strain =
      read("relaxation = \"relaxation.csv\"\nmodulus = \"shear\"\npoisson = 0.25", folder_).material;
  EXPECT_NEAR(strain.mu_ela, 100.0, 1e-6);
  EXPECT_NEAR(strain.lambda_ela, 100.0, 1e-6);  // 2 mu nu / (1 - 2 nu)
  const Material stress =
      read("relaxation = \"relaxation.csv\"\nmodulus = \"shear\"\npoisson = 0.5\nplane = \"stress\"", folder_)
          .material;
  EXPECT_NEAR(stress.lambda_ela, 200.0, 1e-6);  // 2 mu nu / (1 - nu)
}

TEST_F(MeasuredMaterialReader, TakesItsSettings) {
  const Scene scene =
      read("relaxation = \"relaxation.csv\"\npoisson = 0.25\nterms = 1\nweights = \"absolute\"", folder_);
  EXPECT_EQ(scene.origin.measured->weights, FitWeights::absolute);
  EXPECT_LE(scene.origin.measured->fit.series.terms.size(), 1u);
}

TEST_F(MeasuredMaterialReader, TellsOfAPoorFit) {
  write_text(folder_ / "noise.csv", "1,100\n2,3\n3,80\n4,5\n5,90\n");
  EXPECT_THAT(
      read("relaxation = \"noise.csv\"\npoisson = 0.25", folder_).notes,
      ElementsAre(AllOf(HasSubstr("relaxation = \"noise.csv\": the fit is poor"), HasSubstr("absolute"))));
}

TEST_F(MeasuredMaterialReader, NamesMistakes) {
  const auto message = [&](const std::string& csv, const std::string& key = "relaxation") {
    write_text(folder_ / "bad.csv", csv);
    return refusal(key + " = \"bad.csv\"\npoisson = 0.25", folder_);
  };
  EXPECT_THAT(message("1,2,3\n"),
              AllOf(StartsWith("m.toml:7: [material] relaxation = \"bad.csv\": "), HasSubstr("bad.csv:1:"),
                    HasSubstr("2 numbers are needed (time, modulus")));
  EXPECT_THAT(message("1,2\n", "frequency"), HasSubstr("3 numbers are needed (frequency, storage, loss"));
  EXPECT_THAT(message("1,2\n\n-1,2\n3,1\n"), HasSubstr("bad.csv:3: time -1: a number >= 0 (s)"));
  EXPECT_THAT(message("1,2,1\n0,2,1\n", "frequency"), HasSubstr("bad.csv:2: frequency 0: a number > 0 (Hz)"));
  EXPECT_THAT(message("1,2\n"), HasSubstr("bad.csv: 1 point: at least 3 are needed"));
  EXPECT_THAT(message("1,-2\n2,-1\n3,-1\n"), HasSubstr("no modulus above 0"));
  const std::string data = "relaxation = \"relaxation.csv\"\n";
  EXPECT_THAT(refusal(data, folder_), HasSubstr("poisson, Poisson's ratio, is needed beside it"));
  EXPECT_THAT(refusal(data + "poisson = 0.25\nterms = 0", folder_),
              StartsWith("m.toml:9: [material] terms = 0: a whole number of branches from 1 to 20"));
  EXPECT_THAT(refusal(data + "poisson = 0.25\nmodulus = \"bulk\"", folder_),
              HasSubstr("\"young\" or \"shear\""));
  EXPECT_THAT(refusal(data + "poisson = 0.25\nweights = 1", folder_),
              HasSubstr("\"relative\" or \"absolute\""));
  EXPECT_THAT(refusal("relaxation = 3\npoisson = 0.25", folder_),
              HasSubstr("relaxation = 3: a text in quotes"));
  EXPECT_THAT(refusal("relaxation = \"\"\npoisson = 0.25", folder_),
              HasSubstr("the name of a CSV file is needed"));
  EXPECT_THAT(refusal("relaxation = \"none.csv\"\npoisson = 0.25", folder_, Error::Kind::file),
              HasSubstr("none.csv"));
}

}  // namespace
}  // namespace rheo
