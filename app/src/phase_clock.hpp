// Wall-clock seconds that the parts of a command took.
#pragma once

#include <chrono>

namespace app {

struct Seconds {
  double read = 0.0;
  double build = 0.0;
  double simulate = 0.0;
  double draw = 0.0;    // the picture drawn and read back
  double encode = 0.0;  // waited for the encoders, which work beside the drawing
  double write = 0.0;   // tables and result files
};

// Adds the time between its construction and destruction to a sum.
class Timed {
 public:
  explicit Timed(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  ~Timed() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace app
