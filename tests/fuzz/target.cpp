// libFuzzer's way in; RHEO_FEED names the reader.
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "feed.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  // Help goes to standard output; reports of findings do not.
  return std::freopen("/dev/null", "w", stdout) == nullptr ? 1 : 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rheo::fuzz::Sandbox sandbox;
  rheo::fuzz::RHEO_FEED({reinterpret_cast<const char*>(data), size}, sandbox);
  return 0;
}
