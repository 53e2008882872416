#include "daemon/bag/replay/pacer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm::bag {
namespace {

// Rates may be tiny and recordings long: no overflow on the way back to ns.
std::int64_t plus(std::int64_t time, double ns) {
  constexpr auto kMost = 0.5 * static_cast<double>(std::numeric_limits<std::int64_t>::max());
  return time + std::llround(std::clamp(ns, -kMost, kMost));
}

}  // namespace

std::int64_t Pacer::due(std::int64_t recorded) const {
  if (rate_ == 0.0) return now_;
  return plus(now_, static_cast<double>(recorded - recorded_) / rate_);
}

void Pacer::set_rate(double rate, std::int64_t now) {
  take_reference(now);
  rate_ = rate;
}

void Pacer::pause(std::int64_t now) {
  take_reference(now);
  paused_ = true;
}

void Pacer::resume(std::int64_t now) {
  now_ = now;
  paused_ = false;
}

void Pacer::skip_to(std::int64_t recorded) { recorded_ = recorded; }

void Pacer::take_reference(std::int64_t now) {
  if (!paused_) recorded_ = plus(recorded_, static_cast<double>(now - now_) * rate_);
  now_ = now;
}

}  // namespace mpm::bag
