#include "core/nonlinear/nonlinear_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/archive/archive.hpp"
#include "core/nonlinear/calibration.hpp"

namespace mpm {

NonlinearDetector::NonlinearDetector(const RegressionShape& shape, const LinearModel& model,
                                     const Settings& settings)
    : settings_(settings),
      inputs_(shape.inputs),
      results_(static_cast<std::size_t>(shape.inputs * shape.cvs)) {
  if (settings.test == NonlinearTest::kOff) return;
  for (ChannelNonlinearity& result : results_) result.tested = true;
  MemoryLength memory = settings.memory;
  if (memory.window > 0) memory = {(memory.window - 1.0) / (memory.window + 1.0), 0};
  memory.lambda = std::pow(memory.lambda, 1.0 / calibration::nonlinear_test::kLongerMemory);
  for (int j = 0; j < shape.cvs; ++j)
    regressions_.emplace_back(shape, j, model, settings.test, memory, settings.patience);
}

void NonlinearDetector::add_sample(const MismatchDetector& linear) {
  for (NonlinearRegression& regression : regressions_) regression.add_sample(linear.history());
}

void NonlinearDetector::take(int cv, const MismatchDetector& linear) {
  if (on())
    regressions_[static_cast<std::size_t>(cv)].take(linear.history(), linear.regression(cv));
}

void NonlinearDetector::skip(std::int64_t missing, const MismatchDetector& linear) {
  for (NonlinearRegression& regression : regressions_)
    regression.add_gap(static_cast<int>(std::min<std::int64_t>(missing, linear.history().depth())),
                       linear.history());
}

void NonlinearDetector::evaluate(int cv, const MismatchDetector& linear) {
  if (!on()) return;
  take(cv, linear);
  NonlinearRegression& regression = regressions_[static_cast<std::size_t>(cv)];
  if (!regression.ready()) return await_rows(cv);
  ChannelNonlinearity* results = &results_[static_cast<std::size_t>(cv * inputs_)];
  regression.evaluate(settings_.channel_rate, settings_.variation, results);
  for (int i = 0; i < inputs_; ++i) judge(results[i]);
}

void NonlinearDetector::judge(ChannelNonlinearity& result) const {
  const bool unlikely = result.p_value < settings_.channel_rate;
  if (unlikely && result.material) {
    result.verdict = NonlinearVerdict::kNonlinear;
    return;
  }
  result.kind = NonlinearKind::kNone;
  result.verdict = !unlikely && result.smallest_variation <= settings_.variation
                       ? NonlinearVerdict::kLinear
                       : NonlinearVerdict::kUndetermined;
}

// To the linear test a valve that saturates now and then is one change after the other, and each
// one starts afresh. So what was found bent stays so until it can be asked anew.
void NonlinearDetector::await_rows(int cv) {
  for (int i = 0; i < inputs_; ++i) {
    ChannelNonlinearity& result = results_[static_cast<std::size_t>(cv * inputs_ + i)];
    if (result.verdict != NonlinearVerdict::kNonlinear) result = {.tested = on()};
  }
}

void NonlinearDetector::archive(Archive& a) {
  // not archived: settings_, inputs_ (construction)
  a(regressions_, results_);
}

void NonlinearDetector::silence(int cv) {
  for (int i = 0; i < inputs_; ++i)
    results_[static_cast<std::size_t>(cv * inputs_ + i)] = {.tested = on()};
}

}  // namespace mpm
