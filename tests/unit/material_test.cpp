#include "rheo/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io_error_of.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double infinite = std::numeric_limits<double>::infinity();

Material paper() {
  return {7.0, 5.0, 4.0, 2.0, 0.2, Mass::consistent};
}

TEST(Material, RatesAreElasticOverViscousModuli) {
  EXPECT_DOUBLE_EQ(paper().lambda_rate(), 7.0 / 4.0);
  EXPECT_DOUBLE_EQ(paper().mu_rate(), 5.0 / 2.0);
}

TEST(Material, BranchesThatAreOffOrNeverRelaxHaveNoRate) {
  Material material = paper();
  material.lambda_ela = 0.0;
  material.mu_vis = infinite;
  EXPECT_NO_THROW(material.validate());
  EXPECT_EQ(material.lambda_rate(), 0.0);
  EXPECT_EQ(material.mu_rate(), 0.0);
}

TEST(Material, NamesTheParameterThatIsOutOfRange) {
  struct Case {
    double Material::*member;
    const char* name;
    bool zero_allowed, infinite_allowed;
  };
  for (const Case& c :
       {Case{&Material::lambda_ela, "lambda_ela", true, false},
        Case{&Material::mu_ela, "mu_ela", true, false},
        Case{&Material::lambda_vis, "lambda_vis", false, true},
        Case{&Material::mu_vis, "mu_vis", false, true}, Case{&Material::density, "density", false, false}}) {
    for (const double bad : {-1.0, std::nan(""), -infinite, 0.0, infinite}) {
      Material material = paper();
      material.*c.member = bad;
      if ((bad == 0.0 && c.zero_allowed) || (bad == infinite && c.infinite_allowed)) {
        EXPECT_NO_THROW(material.validate()) << c.name << " = " << bad;
      } else {
        EXPECT_THAT(error_of([&] { material.validate("here:"); }),
                    AllOf(StartsWith(std::string("here: ") + c.name + " = "), HasSubstr("is needed")));
      }
    }
  }
}

// Squares and products of such numbers are no numbers of a double any more.
TEST(Material, RefusesSizesThatCannotBeComputedWith) {
  for (double Material::*member : {&Material::lambda_ela, &Material::mu_ela, &Material::lambda_vis,
                                   &Material::mu_vis, &Material::density}) {
    for (const double bad : {1e-320, 0.99e-30, 1.01e30, 1e300}) {
      Material material = paper();
      material.*member = bad;
      EXPECT_THAT(error_of([&] { material.validate(); }), HasSubstr("1e-30 to 1e+30 is allowed"));
    }
    for (const double good : {1e-30, 1e30}) {
      Material material = paper();
      material.*member = good;
      EXPECT_NO_THROW(material.validate());
    }
  }
}

}  // namespace
}  // namespace rheo
