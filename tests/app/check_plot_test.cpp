// check --plot: the tables and the report; the pictures are looked at in check_picture_test.cpp.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class CheckPlot : public ProgramTest {
 protected:
  // The small beam's material with an elastic and a viscous part.
  void write_rich() const {
    write("beam.toml", small_beam_with("density = 0.2",
                                       "density = 0.2\n"
                                       "[material.elastic]\nlambda = 0.5\nmu = 0.25\n"
                                       "[material.viscous]\nlambda = 0.1\nmu = 0"));
  }

  // 100 exp(-t / 2) + 20, exactly.
  void write_measured() const {
    std::string csv = "time,modulus\n";
    for (int i = 0; i < 40; ++i) {
      const double t = 0.05 * std::pow(10.0, i / 15.0);
      csv += fmt::format("{:.17g},{:.17g}\n", t, 100.0 * std::exp(-t / 2.0) + 20.0);
    }
    write("gel.csv", csv);
    write("gel.toml", small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0",
                                      "relaxation = \"gel.csv\"\npoisson = 0.25"));
  }
};

TEST_F(CheckPlot, TablesHoldTheRelaxationFunctionsAndTheComplexModuli) {
  write_rich();
  const Finished finished = rheo({"check", "beam.toml", "--plot", "-o", "m"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(lines_of(read_text(folder() / "m/relaxation.csv"))[0], "t,r_lambda,r_mu");
  EXPECT_EQ(lines_of(read_text(folder() / "m/moduli.csv"))[0],
            "frequency,lambda_storage,lambda_loss,mu_storage,mu_loss");
  const double rounding = 1e-12;  // relative; the tables have all digits
  auto r = read_table(folder() / "m/relaxation.csv");
  ASSERT_GT(r["t"].size(), 100u);
  EXPECT_EQ(r["t"].front(), 0.0);
  EXPECT_NEAR(r["t"][1], 0.4 / 100.0, rounding);
  EXPECT_NEAR(r["t"].back(), 4.0 / 7.0 * 10.0, 10.0 * rounding);
  for (std::size_t i = 0; i < r["t"].size(); ++i) {
    const double t = r["t"][i];
    EXPECT_TRUE(i == 0 || t > r["t"][i - 1]) << i;
    EXPECT_NEAR(r["r_lambda"][i], 7.0 * std::exp(-7.0 / 4.0 * t) + 0.5, 8.0 * rounding);
    EXPECT_NEAR(r["r_mu"][i], 5.0 * std::exp(-5.0 / 2.0 * t) + 0.25, 8.0 * rounding);
  }
  auto g = read_table(folder() / "m/moduli.csv");
  ASSERT_GT(g["frequency"].size(), 100u);
  for (std::size_t i = 0; i < g["frequency"].size(); ++i) {
    const double omega = 2.0 * std::numbers::pi * g["frequency"][i];
    const double y = omega * 4.0 / 7.0, z = omega * 0.4;
    const double scale = 8.0 + 0.1 * omega;
    EXPECT_NEAR(g["lambda_storage"][i], 7.0 * y * y / (1.0 + y * y) + 0.5, scale * rounding);
    EXPECT_NEAR(g["lambda_loss"][i], 7.0 * y / (1.0 + y * y) + 0.1 * omega, scale * rounding);
    EXPECT_NEAR(g["mu_storage"][i], 5.0 * z * z / (1.0 + z * z) + 0.25, scale * rounding);
    EXPECT_NEAR(g["mu_loss"][i], 5.0 * z / (1.0 + z * z), scale * rounding);
  }
}

TEST_F(CheckPlot, TellsTheFitAndItsError) {
  write_measured();
  const Finished finished = rheo({"check", "gel.toml", "--plot", "-o", "m"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out,
              HasSubstr("data           gel.csv: 40 points, Young's modulus over time; poisson = "
                        "0.25, plane strain\n"));
  EXPECT_THAT(finished.out, HasSubstr("fit            1 relaxing term, elastic 20 Pa; error "));
  EXPECT_THAT(finished.out, HasSubstr("lambda         40 Pa, 80 Pa s (relaxation time 2 s)\n"));
  EXPECT_THAT(finished.out, HasSubstr("wrote          m/relaxation.csv\n"));
  const auto json = nlohmann::json::parse(read_text(folder() / "m/run.json"));
  EXPECT_NEAR(json["material"]["maxwell"][0]["mu_ela"], 40.0, 1e-6);
  EXPECT_NEAR(json["material"]["elastic"]["lambda"], 8.0, 1e-6);
  EXPECT_NEAR(json["fit"]["terms"][0]["time"], 2.0, 1e-6);
  EXPECT_LT(json["fit"]["error_rms"], 1e-6);
  EXPECT_EQ(json["read_files"][0]["path"], "gel.csv");
  EXPECT_EQ(json["exit_status"], 0);
}

TEST_F(CheckPlot, HasAFolderOfItsOwn) {
  write("beam.toml", small_beam());
  EXPECT_EQ(rheo({"check", "beam.toml", "--plot"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder() / "out/beam_check/relaxation.csv"));
}

TEST_F(CheckPlot, ReplacesItsEarlierFilesOnlyWhenTold) {
  write_measured();
  ASSERT_EQ(rheo({"check", "gel.toml", "--plot", "-o", "m"}).exit_code, 0);
  write("m/notes.txt", "mine");
  write("beam.toml", small_beam());
  expect_failure(rheo({"check", "beam.toml", "--plot", "-o", "m"}), 2, {"m: holds the results", "--force"});
  EXPECT_EQ(rheo({"check", "beam.toml", "--plot", "-o", "m", "--force"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder() / "m/fit.png"));  // the earlier scene's
  EXPECT_TRUE(fs::exists(folder() / "m/notes.txt"));
}

TEST_F(CheckPlot, WritesNothingForABadScene) {
  write("beam.toml", small_beam_with("mu_ela = 5.0", "mu_ela = -5.0"));
  expect_failure(rheo({"check", "beam.toml", "--plot"}), 2, {"mu_ela = -5.0"});
  EXPECT_THAT(files(), ElementsAre("beam.toml"));
}

TEST_F(CheckPlot, AMachineThatCannotDrawStillMakesTheTables) {
  write_measured();
  const Finished finished =
      rheo({"check", "gel.toml", "--plot", "-o", "m", "--backend", "egl"},
           {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json"}, {"LIBGL_DRIVERS_PATH", "/nowhere"}});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("note: no picture: "));
  EXPECT_THAT(files(),
              ElementsAre("gel.csv", "gel.toml", "m", "m/moduli.csv", "m/relaxation.csv", "m/run.json"));
}

TEST_F(CheckPlot, ARunTellsOfAPoorFit) {
  write("gel.csv", "1,100\n2,3\n3,80\n4,5\n5,90\n");
  write("gel.toml", small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0",
                                    "relaxation = \"gel.csv\"\npoisson = 0.25"));
  EXPECT_THAT(rheo({"check", "gel.toml"}).out, HasSubstr("note: relaxation = \"gel.csv\": the fit is poor"));
}

}  // namespace
}  // namespace app_tests
