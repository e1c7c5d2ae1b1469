// A context to draw with, or the end of the test.
#pragma once

#include "ui_driver.hpp"

#define RHEO_DRAW_OR_SKIP(context)                 \
  const auto context = view_tests::open_or_null(); \
  if (!context) GTEST_SKIP() << "this machine has no way to draw (libosmesa6)"
