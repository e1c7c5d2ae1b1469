#include "rheo/material_presets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "rheo/relaxation.hpp"

namespace rheo {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Material preset(const std::string& name, const std::vector<Moduli>& values) {
  const Preset* found = find_preset(name);
  EXPECT_NE(found, nullptr) << name;
  Material m = expanded(*found, values);
  m.density = 1.0;
  EXPECT_NO_THROW(m.validate()) << name;
  return m;
}

// A spring and a dashpot in series or parallel under a vibration: moduli add in parallel, compliances in
// series.
using Complex = std::complex<double>;
Complex dashpot(double vis, double omega) {
  return {0.0, omega * vis};
}
Complex in_series(Complex a, Complex b) {
  return 1.0 / (1.0 / a + 1.0 / b);
}

// The preset's lambda and mu against the circuit's own moduli, which know no relaxation times.
template <typename Circuit>
void expect_circuit(const Material& m, const std::vector<Moduli>& values, Circuit circuit) {
  for (const double omega : {1e-4, 1e-2, 0.3, 1.0, 7.0, 1e3}) {
    std::vector<double> lambda, mu;
    for (const Moduli& v : values) {
      lambda.push_back(v.lambda);
      mu.push_back(v.mu);
    }
    const Complex l = circuit(lambda, omega), u = circuit(mu, omega);
    const ComplexModuli g = complex_moduli(m, omega);
    const double rounding = 1e-13;
    EXPECT_NEAR(g.storage.lambda, l.real(), rounding * std::abs(l)) << omega;
    EXPECT_NEAR(g.loss.lambda, l.imag(), rounding * std::abs(l)) << omega;
    EXPECT_NEAR(g.storage.mu, u.real(), rounding * std::abs(u)) << omega;
    EXPECT_NEAR(g.loss.mu, u.imag(), rounding * std::abs(u)) << omega;
  }
}

TEST(MaterialPresets, AreTheModuliOfTheirCircuits) {
  using V = std::vector<double>;
  const std::vector<Moduli> five{{7.0, 5.0}, {4.0, 2.0}, {1.5, 0.5}, {30.0, 20.0}, {0.2, 0.1}};
  const auto first = [&](std::size_t n) {
    return std::vector<Moduli>(five.begin(), five.begin() + static_cast<std::ptrdiff_t>(n));
  };
  expect_circuit(preset("elastic", first(1)), five, [](const V& v, double) { return Complex(v[0]); });
  expect_circuit(preset("plastic", first(1)), five, [](const V& v, double w) { return dashpot(v[0], w); });
  expect_circuit(preset("kelvin_voigt", first(2)), five,
                 [](const V& v, double w) { return v[0] + dashpot(v[1], w); });
  expect_circuit(preset("maxwell", first(2)), five,
                 [](const V& v, double w) { return in_series(v[0], dashpot(v[1], w)); });
  expect_circuit(preset("zener", first(3)), five,
                 [](const V& v, double w) { return in_series(v[0], dashpot(v[1], w)) + v[2]; });
  expect_circuit(preset("burgers_equivalent", first(4)), five, [](const V& v, double w) {
    return in_series(in_series(v[0], dashpot(v[1], w)), v[2] + dashpot(v[3], w));
  });
  expect_circuit(preset("five_element", five), five, [](const V& v, double w) {
    return in_series(v[0], dashpot(v[1], w)) + in_series(v[2], dashpot(v[3], w)) + dashpot(v[4], w);
  });
  EXPECT_EQ(material_presets().size(), 7u);
}

// Findley, Lai and Onaran (1976), table 5.1: sigma + p1 sigma' + p2 sigma'' = q1 epsilon' + q2 epsilon''.
TEST(MaterialPresets, BurgersHasTheTextbooksTimesAndWeights) {
  const double R1 = 7.0, eta1 = 40.0, R2 = 3.0, eta2 = 2.0;
  const double p1 = eta1 / R1 + eta1 / R2 + eta2 / R2, p2 = eta1 * eta2 / (R1 * R2);
  const double q1 = eta1, q2 = eta1 * eta2 / R2, A = std::sqrt(p1 * p1 - 4.0 * p2);
  const double r1 = (p1 - A) / (2.0 * p2), r2 = (p1 + A) / (2.0 * p2);
  const Material m =
      preset("burgers_equivalent", {{R1, 2 * R1}, {eta1, 2 * eta1}, {R2, 2 * R2}, {eta2, 2 * eta2}});
  ASSERT_EQ(m.branch_count(), 2u);
  const double rounding = 1e-12;  // A and r1 here are differences
  EXPECT_NEAR(m.branch(0).lambda_rate(), r1, rounding * r1);
  EXPECT_NEAR(m.branch(1).lambda_rate(), r2, rounding * r2);
  EXPECT_NEAR(m.branch(0).lambda_ela, (q1 - q2 * r1) / A, rounding * R1);
  EXPECT_NEAR(m.branch(1).lambda_ela, (q2 * r2 - q1) / A, rounding * R1);
  EXPECT_NEAR(m.branch(0).mu_rate(), r1, rounding * r1);
  EXPECT_NEAR(m.branch(1).mu_ela, 2.0 * (q2 * r2 - q1) / A, rounding * R1);
}

TEST(MaterialPresets, BurgersKeepsItsDigitsOverManyDecades) {
  for (const double vis_1 : {1e-4, 1.0, 1e4})
    for (const double ela_2 : {1e-4, 1.0, 1e4})
      for (const double vis_2 : {1e-4, 1.0, 1e4}) {
        const double ela_1 = 3.0;
        const Material m =
            preset("burgers_equivalent", {{ela_1, ela_1}, {vis_1, vis_1}, {ela_2, ela_2}, {vis_2, vis_2}});
        const MaxwellBranch slow = m.branch(0), fast = m.branch(1);
        EXPECT_NEAR(slow.lambda_ela + fast.lambda_ela, ela_1, 1e-14 * ela_1);
        // The whole of it flows as its first dashpot.
        EXPECT_NEAR(slow.lambda_vis + fast.lambda_vis, vis_1, 1e-13 * vis_1);
        EXPECT_GT(slow.lambda_ela, 0.0);
        EXPECT_GT(fast.lambda_ela, 0.0);
        EXPECT_LT(slow.lambda_rate(), fast.lambda_rate());
      }
}

TEST(MaterialPresets, BurgersWithoutASpringIsWhatIsLeft) {
  const Material off = preset("burgers_equivalent", {{0.0, 7.0}, {1.0, 4.0}, {1.0, 0.0}, {1.0, 2.0}});
  EXPECT_EQ(relaxation(off, 0.0).lambda, 0.0);
  EXPECT_DOUBLE_EQ(relaxation(off, 0.0).mu, 7.0);
  // Two dashpots in series: the fluidities add.
  EXPECT_NEAR(off.branch(0).mu_vis, 4.0 * 2.0 / (4.0 + 2.0), 1e-15);
}

TEST(MaterialPresets, ReplaceWhatAMaterialHad) {
  Material m{.lambda_ela = 1.0, .mu_ela = 1.0, .lambda_vis = 1.0, .mu_vis = 1.0, .density = 3.0};
  m.more_branches = {{1.0, 1.0, infinite, infinite}};
  m.viscous = {1.0, 1.0};
  const std::array<Moduli, 1> values{Moduli{2.0, 3.0}};
  const Material elastic = expanded(*find_preset("elastic"), values, m);
  EXPECT_EQ(elastic.density, 3.0);
  EXPECT_EQ(elastic.lambda_ela, 0.0);
  EXPECT_TRUE(elastic.more_branches.empty());
  EXPECT_EQ(elastic.viscous.mu, 0.0);
  EXPECT_EQ(elastic.elastic.mu, 3.0);
}

TEST(MaterialPresets, NameTheirSourcesAndCircuits) {
  for (const Preset& p : material_presets()) {
    EXPECT_FALSE(p.source.empty()) << p.name;
    for (const PresetElement& element : p.elements)
      EXPECT_NE(p.circuit.find(element.name), std::string::npos) << p.name;
  }
  EXPECT_EQ(find_preset("jelly"), nullptr);
}

}  // namespace
}  // namespace rheo
