#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Numbers as people read them.
namespace mpm {

/// `digits` significant ones, no exponent between 1e-4 and 1e7, no trailing zeros; "-" for NaN.
[[nodiscard]] std::string number_text(double value, int digits = 3);
/// "0.72 to 0.78"; with more digits where the ends would look alike.
[[nodiscard]] std::string interval_text(double low, double high, int digits = 3);
/// "25 %" of 0.25
[[nodiscard]] std::string percent_text(double share, int digits = 2);
/// How sure something is, of 0..1: "0.95", "0.996", "> 0.999"; never "1".
[[nodiscard]] std::string confidence_text(double probability);
/// The same as "95 %", "99.6 %", "> 99.9 %"; never "100 %".
[[nodiscard]] std::string sure_text(double probability);
/// "45 s", "90 min", "8 h", "7 d": in the largest unit that leaves a whole number, or with digits.
[[nodiscard]] std::string duration_text(double seconds);
/// "1 sample", "2 samples" of "sample"
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view what);

}  // namespace mpm
