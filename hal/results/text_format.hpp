// Numbers as text: the same bytes on every machine and in every locale. A number that is not finite leaves an
// empty field, so that no NaN ever reaches a file; minus zero is written as zero.
#pragma once

#include <cstdint>
#include <string>

namespace st {

void append_fixed(std::string& out, double value, int decimals);       // 12.340
void append_scientific(std::string& out, double value, int decimals);  // 1.234e+01
void append_integer(std::string& out, std::int64_t value);
// A yaw in (-pi, pi], also after rounding: the nearest six-decimal neighbours of pi would lie just outside.
void append_yaw(std::string& out, double yaw_rad);

// How many decimals each kind of quantity gets. Few enough that noise of the last bit never shows, more than
// any sensor here resolves.
inline constexpr int kStampDecimals = 6;
inline constexpr int kMetreDecimals = 6;
inline constexpr int kRadianDecimals = 6;
inline constexpr int kQuaternionDecimals = 8;
inline constexpr int kRatioDecimals = 4;
inline constexpr int kMicrosecondDecimals = 1;

}  // namespace st
