// A build without the renderer says so.
#include <gmock/gmock.h>

#include "program.hpp"

namespace app_tests {
namespace {

class NoRenderer : public ProgramTest {};

TEST_F(NoRenderer, RenderIsRefusedBeforeAnythingIsWritten) {
  write("beam.toml", small_beam());
  expect_failure(rheo({"render", "beam.toml"}), 2, {"no renderer", "rheo run", "RHEO_RENDER=ON"});
  EXPECT_THAT(files(), testing::ElementsAre("beam.toml"));
}

}  // namespace
}  // namespace app_tests
