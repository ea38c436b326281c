// True in builds with ASan or TSan: their shadow memory takes page faults of its own, and mlock() does
// nothing there.
#pragma once

namespace st {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace st
