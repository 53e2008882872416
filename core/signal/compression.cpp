#include "core/signal/compression.hpp"

#include <algorithm>
#include <cmath>

#include "core/signal/calibration.hpp"

namespace mpm {

namespace compression = calibration::compression;

void Compression::take(double value) {
  if (!begun_) {
    last_ = value;
    begun_ = true;
    return;
  }
  ++batch_.values;
  const double change = value - last_;
  last_ = value;
  run_ = change == 0.0 ? run_ + 1 : 0;
  if (run_ == 0)
    take_change(change);
  else if (run_ == 1)
    ++batch_.rests;
}

void Compression::take_change(double change) {
  const double size = std::abs(change), last_size = std::abs(last_change_);
  const double bend = std::abs(change - last_change_);
  const bool straight = bend <= compression::kStraight * std::min(size, last_size);
  batch_.straight += straight ? 1 : 0;
  batch_.bends += was_straight_ && bend > compression::kBend * std::max(size, last_size) ? 1 : 0;
  batch_.returns += std::abs(change + last_change_) <= compression::kSame * size ? 1 : 0;
  was_straight_ = straight;

  const auto at_most = [&](double step) {
    if (step > compression::kSame * size)
      batch_.smallest = batch_.smallest > 0.0 ? std::min(batch_.smallest, step) : step;
  };
  at_most(size);
  if (last_size > 0.0) at_most(std::abs(size - last_size));
  last_change_ = change;
  jumps_[static_cast<std::size_t>(batch_.changes)] = size;
  ++batch_.changes;
  const bool rare =
      batch_.changes >= compression::kFewestChanges && batch_.values >= compression::kMostValues;
  if (batch_.changes < compression::kChanges && !rare) return;
  found_ = held() || interpolated();
  batch_ = {};
}

bool Compression::held() const {
  if (batch_.rests < compression::kRested * batch_.changes) return false;
  const auto smallest =
      std::count_if(jumps_.begin(), jumps_.begin() + batch_.changes,
                    [&](double jump) { return jump < compression::kOneStep * batch_.smallest; });
  return static_cast<double>(smallest) < compression::kResolved * batch_.changes;
}

bool Compression::interpolated() const {
  const double bends =
      batch_.straight > compression::kMostlyStraight * batch_.changes ? 0.0 : compression::kBends;
  return batch_.straight > compression::kStraightShare * batch_.changes &&
         batch_.bends > bends * batch_.changes &&
         batch_.returns < compression::kResolved * batch_.changes;
}

}  // namespace mpm
