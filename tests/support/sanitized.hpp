// Sanitizers make a test ten to twenty times as slow: what measures over and over is done less often in their
// builds, over the same paths. Released builds do all of it.
#pragma once

namespace rheo::test {

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

}  // namespace rheo::test
