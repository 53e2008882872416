#include "sim/signals/test_signals.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::sim {

TestSignals::TestSignals(const std::vector<config::TestSignal>& tests,
                         const std::vector<std::string>& mvs, const Eigen::VectorXd& origin,
                         double sample_time_s, std::uint64_t seed)
    : origin_(origin), values_(origin) {
  for (const config::TestSignal& test : tests) {
    const auto mv = std::find(mvs.begin(), mvs.end(), test.mv) - mvs.begin();
    const auto hold = std::max<std::int64_t>(1, std::llround(test.hold_s / sample_time_s));
    tests_.push_back({mv,
                      test.size,
                      hold,
                      test.random,
                      {test.from_s, test.until_s, sample_time_s},
                      RandomStream(seed, StreamPurpose::kTest, tests_.size()),
                      -1.0});
  }
}

bool TestSignals::advance(std::int64_t interval) {
  bool any = false;
  values_ = origin_;
  for (Test& test : tests_) {
    if (!test.when.contains(interval)) continue;
    any = true;
    if ((interval - test.when.first) % test.hold == 0)
      test.level = test.random ? (test.stream.below(2) == 0 ? -1.0 : 1.0) : -test.level;
    values_(test.mv) += test.level * test.size;
  }
  return any;
}

}  // namespace mpm::sim
