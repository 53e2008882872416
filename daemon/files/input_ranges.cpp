#include "daemon/files/input_ranges.hpp"

#include <algorithm>

namespace mpm::files {
namespace {

// Chosen: operators narrow an MV's limits and free it again; nobody sets them so wrong.
constexpr double kDistancesOutside = 8.0;

}  // namespace

InputRanges::InputRanges(const config::UnitConfig& unit, Purpose purpose) {
  if (purpose == Purpose::kKeep) return;
  const auto add = [this](SignalKind kind, std::size_t index, const SignalLimits& limits) {
    if (!limits.low || !limits.high) return;
    const double outside = kDistancesOutside * (*limits.high - *limits.low);
    ranges_.push_back(
        {kind, static_cast<int>(index), *limits.low - outside, *limits.high + outside});
  };
  for (std::size_t i = 0; i < unit.mv.size(); ++i) add(SignalKind::kMv, i, unit.mv_limits(i));
  for (std::size_t i = 0; i < unit.dv.size(); ++i) add(SignalKind::kDv, i, unit.dv[i].limits);
}

void InputRanges::mark(Frame& frame) const {
  for (const Range& range : ranges_) {
    SignalBlock& block = frame[range.kind];
    const double value = block.values(range.index);
    Quality& quality = block.quality[static_cast<std::size_t>(range.index)];
    if (value < range.low || value > range.high) quality = std::max(quality, Quality::kImplausible);
  }
}

}  // namespace mpm::files
