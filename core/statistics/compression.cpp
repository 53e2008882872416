#include "core/statistics/compression.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"

namespace mpm {

void Compression::take(double value) {
  if (!begun_) {
    last_ = value;
    begun_ = true;
    return;
  }
  ++batch_.values;
  const double change = value - last_;
  last_ = value;
  if (change != 0.0)
    take_change(change);
  else if (!rests_)
    ++batch_.rests;
  rests_ = change == 0.0;
}

bool Compression::straight(double change, double last_change) {
  return change != 0.0 &&
         std::abs(change - last_change) <=
             compression::kStraight * std::min(std::abs(change), std::abs(last_change));
}

void Compression::take_change(double change) {
  const double size = std::abs(change), last_size = std::abs(last_change_);
  const double bend = std::abs(change - last_change_);
  const bool on_line = !rests_ && straight(change, last_change_);
  const bool back = std::abs(change + last_change_) <= compression::kSame * size;
  batch_.straight += on_line ? 1 : 0;
  batch_.bends += was_straight_ && bend > compression::kBend * std::max(size, last_size) ? 1 : 0;
  batch_.returns += !was_straight_ && back ? 1 : 0;
  was_straight_ = on_line;

  const auto at_most = [&](double step) {
    if (step > compression::kSame * size)
      batch_.smallest = batch_.smallest > 0.0 ? std::min(batch_.smallest, step) : step;
  };
  at_most(size);
  if (last_size > 0.0) at_most(std::abs(size - last_size));
  last_change_ = change;
  sizes_[static_cast<std::size_t>(batch_.changes++)] = size;
  const bool rare =
      batch_.changes >= compression::kFewestChanges && batch_.values >= compression::kMostValues;
  if (batch_.changes == compression::kChanges || rare) judge();
}

void Compression::conclude() {
  if (batch_.changes >= compression::kFewestChanges) judge();
}

void Compression::Batch::archive(Archive& a) {
  a(values, rests, smallest, straight, bends, returns);
  a.within(changes, 0, compression::kChanges - 1);
}

void Compression::archive(Archive& a) {
  a(batch_, sizes_, begun_, rests_, last_, last_change_, was_straight_, smallest_change_,
    held_for_);
  a.within(kind_, Kind::kNone, Kind::kInterpolated);
  a.require(
      std::all_of(sizes_.begin(), sizes_.end(), [](double each) { return std::isfinite(each); }),
      "a change that is none");
}

void Compression::judge() {
  kind_ = held() ? Kind::kHeld : interpolated() ? Kind::kInterpolated : Kind::kNone;
  smallest_change_ = *std::min_element(sizes_.begin(), sizes_.begin() + batch_.changes);
  held_for_ = static_cast<double>(batch_.values) / batch_.changes;
  batch_ = {};
}

double Compression::share_below(double size) const {
  const auto below = std::count_if(sizes_.begin(), sizes_.begin() + batch_.changes,
                                   [size](double each) { return each < size; });
  return static_cast<double>(below) / batch_.changes;
}

bool Compression::few_sizes() const {
  int sizes = 1;
  for (std::size_t i = 1; i < static_cast<std::size_t>(batch_.changes); ++i)
    sizes += sizes_[i] - sizes_[i - 1] > compression::kSame * sizes_[i] ? 1 : 0;
  return sizes < compression::kFewestSizes;
}

bool Compression::held() {
  if (batch_.rests < compression::kRested * batch_.changes) return false;
  std::sort(sizes_.begin(), sizes_.begin() + batch_.changes);
  if (few_sizes()) return false;
  const auto median = sizes_.begin() + batch_.changes / 2;
  const double small =
      batch_.changes == compression::kChanges ? compression::kSmallMove : compression::kSmallOfRare;
  return share_below(small * *median) < compression::kFewSmall &&
         share_below(compression::kOneStep * batch_.smallest) < compression::kFewResolved;
}

bool Compression::interpolated() const {
  const double bends =
      batch_.straight > compression::kMostlyStraight * batch_.changes ? 0.0 : compression::kBends;
  return batch_.straight > compression::kStraightShare * batch_.changes &&
         batch_.bends > bends * batch_.changes &&
         batch_.returns < compression::kFewResolved * batch_.changes;
}

}  // namespace mpm
