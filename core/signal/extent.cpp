#include "core/signal/extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/archive/archive.hpp"

namespace mpm {

using calibration::extent::kDigits;
using calibration::extent::kIsolated;
using calibration::extent::kLongestBurst;
using calibration::extent::kTooFar;

Extent::Verdict Extent::learn(double value) {
  if (known()) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    return {};
  }
  first_[taken_++] = value;
  return known() ? judge_first() : Verdict{};
}

// A burst leaves at least so many of them close together. What lies far from these, once, and was
// back there from one value to the next, is an excursion; what comes back step by step, or twice,
// is none, unless it was too far away for any process.
Extent::Verdict Extent::judge_first() {
  constexpr std::size_t kClose = kFirst - kLongestBurst;
  std::array<double, kFirst> sorted = first_;
  std::sort(sorted.begin(), sorted.end());
  std::size_t from = 0;
  for (std::size_t i = 1; i + kClose <= kFirst; ++i)
    if (sorted[i + kClose - 1] - sorted[i] < sorted[from + kClose - 1] - sorted[from]) from = i;
  low_ = sorted[from];
  high_ = sorted[from + kClose - 1];
  const auto isolated = [this](double value) { return beyond(value) > kIsolated; };
  const auto begin = std::find_if(first_.begin(), first_.end(), isolated);
  auto end = begin;
  while (end != first_.end() && (end == begin || isolated(*end) || !back(*end, *(end - 1)))) ++end;
  const bool is_one = begin != first_.end() && (end == first_.end() || isolated(*(end - 1))) &&
                      std::none_of(end, first_.end(), isolated);
  const Extent closest = *this;
  bool wild = is_one;
  for (auto value = first_.begin(); value != first_.end(); ++value) {
    const bool too_far = closest.width() > 0.0 && closest.beyond(*value) > kTooFar;
    wild = wild || too_far;
    if (too_far || (is_one && value >= begin && value < end)) continue;
    low_ = std::min(low_, *value);
    high_ = std::max(high_, *value);
  }
  if (!is_one) return {wild, 0};
  return {end != first_.end(), end == first_.end() ? static_cast<int>(end - begin) : 0};
}

void Extent::archive(Archive& a) {
  a(low_, high_, first_);
  a.within(taken_, 0, kFirst);
  a.require(
      std::all_of(first_.begin(), first_.end(), [](double each) { return std::isfinite(each); }),
      "a first value that is none");
}

double Extent::width() const {
  const double width = high_ - low_;
  return width > kDigits * std::max(std::abs(low_), std::abs(high_)) ? width : 0.0;
}

double Extent::outside(double value) const { return std::max({low_ - value, value - high_, 0.0}); }

double Extent::beyond(double value) const {
  const double far = outside(value);
  if (far == 0.0) return 0.0;
  return width() > 0.0 ? far / width() : std::numeric_limits<double>::infinity();
}

bool Extent::back(double value, double before) const {
  return beyond(value) <= calibration::extent::kHome ||
         outside(value) < calibration::extent::kBackShare * outside(before);
}

}  // namespace mpm
