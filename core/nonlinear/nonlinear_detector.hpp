#pragma once

#include <vector>

#include "core/mismatch/mismatch_detector.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"
#include "core/nonlinear/nonlinear_regression.hpp"

namespace mpm {

class Archive;

/// The nonlinear test of all channels of a unit, beside the linear one (`MismatchDetector`), which
/// it reads and leaves as it is. No allocation but where a CV's regression begins.
class NonlinearDetector {
 public:
  struct Settings {
    NonlinearTest test = NonlinearTest::kOff;
    MemoryLength memory;        ///< the linear test's long one; a window fades instead
    int patience = 1;           ///< samples from one `take` of a CV to the next, at most
    double channel_rate = 0.0;  ///< p-value below which a channel counts as nonlinear
    double variation = 0.0;     ///< of the local gain, that must show for `linear`, relative
  };

  NonlinearDetector(const RegressionShape& shape, const LinearModel& model,
                    const Settings& settings);

  [[nodiscard]] bool on() const { return !regressions_.empty(); }
  /// After the linear detector took a sample.
  void add_sample(const MismatchDetector& linear);
  /// After it folded a CV, and before it skips samples.
  void take(int cv, const MismatchDetector& linear);
  /// After it skipped so many samples (>= 1).
  void skip(std::int64_t missing, const MismatchDetector& linear);
  /// Takes what waits and brings the results of a CV's channels up to date. After a fresh start of
  /// the linear test what was `nonlinear` stays so until there are rows enough again.
  void evaluate(int cv, const MismatchDetector& linear);
  /// As of the last `evaluate`; undetermined before the first one, or where the test is off.
  [[nodiscard]] const ChannelNonlinearity& result(int cv, int input) const {
    return results_[static_cast<std::size_t>(cv * inputs_ + input)];
  }
  /// Forgets what was said of a CV.
  void silence(int cv);
  [[nodiscard]] const NonlinearRegression& regression(int cv) const {
    return regressions_[static_cast<std::size_t>(cv)];
  }

  void archive(Archive& a);

 private:
  void judge(ChannelNonlinearity& result) const;
  void await_rows(int cv);

  Settings settings_;
  int inputs_;
  std::vector<NonlinearRegression> regressions_;  // per CV; none where the test is off
  std::vector<ChannelNonlinearity> results_;      // CV-major
};

}  // namespace mpm
