// The paper's beam against states computed independently of this project by a matrix exponential.

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "support/exact.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

const std::vector<double> times{0.5, 1.0, 2.0, 5.0};

ExactState read_state(const std::string& name, double t) {
  std::ifstream file(std::string(RHEO_TEST_DATA "/reference/") + name);
  if (!file) throw std::runtime_error("cannot read " + name);
  std::string line;
  std::getline(file, line);
  std::vector<std::array<double, 11>> rows;
  while (std::getline(file, line)) {
    std::array<double, 11> row{};
    std::stringstream cells(line);
    std::string cell;
    for (double& x : row) {
      std::getline(cells, cell, ',');
      x = std::stod(cell);
    }
    rows.push_back(row);
  }
  const auto block = [&](int column) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) x.segment<2>(2 * i) << rows[i][column], rows[i][column + 1];
    return x;
  };
  return {t, block(3), block(5), block(7), block(9)};
}

std::vector<ExactState> reference(Mass mass) {
  const std::string name = mass == Mass::lumped ? "beam_lumped_t" : "beam_consistent_t";
  return {read_state(name + "0.5.csv", 0.5), read_state(name + "1.csv", 1), read_state(name + "2.csv", 2),
          read_state(name + "5.csv", 5)};
}

// Prints what it measures: the README quotes it.
double beam_error(Mass mass, double step, IntegratorKind integrator = IntegratorKind::rk4) {
  Scene scene = paper_beam(mass);
  scene.time.step = step;
  scene.time.integrator = integrator;
  const double error = run_error(reference(mass), simulate(scene, times));
  std::printf("%s mass, %s, step %s: error %.2e\n", mass == Mass::lumped ? "lumped" : "consistent",
              integrator == IntegratorKind::rk4 ? "rk4" : "euler",
              step > 0.0 ? std::to_string(step).c_str() : "auto", error);
  return error;
}

TEST(Reference, ExactSolutionOfTheTestsAgrees) {
  // Two matrix exponentials of the same 80 x 80 problem over 5 s: rounding only.
  EXPECT_LT(run_error(reference(Mass::lumped), ExactSolution(paper_beam(Mass::lumped)).at(times)), 1e-11);
  EXPECT_LT(run_error(reference(Mass::consistent), ExactSolution(paper_beam(Mass::consistent)).at(times)),
            1e-11);
}

TEST(Reference, LumpedBeamWithinTwoInABillion) {
  EXPECT_LE(beam_error(Mass::lumped, 1e-4), 2e-9);
}

TEST(Reference, ConsistentBeamWithinEightInAHundredMillion) {
  EXPECT_LE(beam_error(Mass::consistent, 1e-4), 8e-8);
}

TEST(Reference, CoarserStepsAndEulerAreAsTheReadmeSays) {
  // A tenth above what was measured when the README was written.
  EXPECT_LE(beam_error(Mass::lumped, 1e-3), 1.1e-5);
  EXPECT_LE(beam_error(Mass::consistent, 1e-3), 4.5e-4);
  EXPECT_LE(beam_error(Mass::lumped, 0.0), 1.8e-2);
  EXPECT_LE(beam_error(Mass::consistent, 0.0), 5.8e-2);
  EXPECT_LE(beam_error(Mass::lumped, 2e-5, IntegratorKind::euler), 1.3e-2);
  EXPECT_LE(beam_error(Mass::consistent, 2e-5, IntegratorKind::euler), 5.4e-2);
}

TEST(Reference, ErrorFallsSixteenfoldAStepHalved) {
  const double coarse = beam_error(Mass::lumped, 4e-4);
  const double fine = beam_error(Mass::lumped, 2e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.1);
}

}  // namespace
}  // namespace rheo::test
