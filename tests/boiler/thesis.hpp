#pragma once

#include <array>
#include <optional>

/// What Carlsson (2010), chapter 5, prints of its boiler; signals in the unit file's order.
namespace mpm::boiler::thesis {

/// Table 5.4.
inline constexpr std::array kRestMv = {30.0, 135.0, 130.0, 30.0};
inline constexpr std::array kRestCv = {389.0, 444.0, 5.88, 272.0};

/// Where the axis of each panel of figure 5.2 ends, CV units per MV unit; CV by MV.
using AxisEnd = std::optional<double>;
inline constexpr std::array<std::array<AxisEnd, 4>, 4> kStepAxis = {{
    {-0.8, 2.0, -0.6, 10.0},
    {-0.4, 0.6, -0.02, -15.0},
    {0.08, -0.08, -0.02, std::nullopt},
    {-4.0, 6.0, 2.0, std::nullopt},
}};

/// Table 5.6: variance of the control error, share of the time at limits.
struct Control {
  std::array<double, 4> variance;
  std::array<double, 4> at_limits;
};
inline constexpr Control kCommissioned = {{33.5, 3.6, 0.261, 37.5}, {0.0, 0.0, 0.22, 0.15}};
inline constexpr Control kMismatch = {{36.3, 3.83, 0.216, 46.0}, {0.44, 0.0, 0.54, 0.25}};

}  // namespace mpm::boiler::thesis
