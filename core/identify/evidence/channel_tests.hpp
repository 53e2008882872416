#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identify/evidence/calibration.hpp"
#include "core/identify/evidence/regress_recording.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// What the calibrated test of the monitor (`MismatchDetector`) says of every channel on a whole
/// recording, all rows counting alike: whether the model's error of a CV goes with the past of an
/// input. It is valid under feedback and whatever disturbs the CV, which no free run is: what it
/// does not reject is no reason to name anything in that channel.
class ChannelTests {
 public:
  /// `model` in channels, with the recording's aux signals as inputs after its own. `residuals`:
  /// samples x CVs, measured minus free run, NaN where unknown.
  ChannelTests(const ModelSpec& model, const Recording& recording, const Eigen::MatrixXd& residuals,
               OwnPast past = OwnPast::kLags);

  /// 0..1 of the channel's match; nothing where the data do not suffice for a test or the input
  /// does not move, and of set-points, which are no inputs of it. Aux signals are numbered after
  /// the inputs.
  [[nodiscard]] std::optional<double> p_value(int cv, int input) const {
    const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
    return channel < p_values_.size() ? p_values_[channel] : std::nullopt;
  }
  /// 0..1 of the channel's error being within the usual limits of materiality, by the monitor's
  /// test of small errors or by the sizes found of any; 1 where there is no test.
  [[nodiscard]] double harmless_p_value(int cv, int input) const {
    const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
    return channel < harmless_.size() ? harmless_[channel] : 1.0;
  }
  /// Error of the channel's gain that it measures, relative to the model's, whatever else is wrong
  /// of the channel; of infinite s.d. where there is no test.
  [[nodiscard]] Estimate gain_error(int cv, int input) const {
    const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
    return channel < gain_errors_.size() ? gain_errors_[channel] : Estimate{};
  }
  /// How much wrong that test sees, CV units squared: its F, which is relative to the noise that
  /// the model leaves, times the mean square of the residual's steps from row to row; 0 where there
  /// is no test.
  [[nodiscard]] double wrong(int cv, int input) const {
    const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
    return channel < wrong_.size() ? wrong_[channel] : 0.0;
  }
  /// What the set-points say of a CV in which something is off, beside errors of its channels:
  /// whether the one that says most explains clearly more or less than those. Where nothing is off,
  /// the recording is too long to look, or with the past as the monitor's, nothing loses or wins.
  [[nodiscard]] const RivalSignal& setpoint(int cv) const {
    return setpoints_[static_cast<std::size_t>(cv)];
  }
  /// Whether some of these channels do not match: the smallest p-value times their number is at
  /// most `level` (0..1).
  [[nodiscard]] bool reject(const std::vector<std::pair<int, int>>& channels,
                            double level = kRejected) const;
  /// Whether the error of some of these channels may matter: "too small" has at most this p-value.
  [[nodiscard]] bool may_matter(const std::vector<std::pair<int, int>>& channels,
                                double level = kMayMatter) const;
  /// Whether the monitor would raise no alarm for any of these channels, whatever the sizes of
  /// their errors: "what it does to the step response bears no more than the limits" has more than
  /// this p-value for each.
  [[nodiscard]] bool bears(const std::vector<std::pair<int, int>>& channels,
                           double level = kMayMatter) const;
  /// Whether other inputs undo most of what the input of some of these channels does, so that small
  /// errors of any kind are large ones of what is left.
  [[nodiscard]] bool undone(const std::vector<std::pair<int, int>>& channels) const;
  /// Whether the nonlinear test of the monitor, where it was asked (`OwnPast::kAsMonitor`), says of
  /// some of these channels that no linear error explains what they do.
  [[nodiscard]] bool bends(const std::vector<std::pair<int, int>>& channels) const;
  /// Those whose noise goes before that of a CV, the surest first: its regression rests on their
  /// residuals (`CoupledCvs`).
  [[nodiscard]] const std::vector<int>& noise_before(int cv) const {
    return noise_before_[static_cast<std::size_t>(cv)];
  }
  /// All channels to a CV, as (CV, input).
  [[nodiscard]] std::vector<std::pair<int, int>> channels_to(int cv) const;

 private:
  int cvs_;
  std::vector<std::optional<double>> p_values_;  // per channel, input-major
  std::vector<double> harmless_;                 // likewise
  std::vector<double> borne_;                    // likewise
  std::vector<Estimate> gain_errors_;            // likewise
  std::vector<double> wrong_;                    // likewise
  std::vector<double> masked_;                   // likewise: s.d. of its gain to that of it alone
  std::vector<bool> bends_;                      // likewise
  std::vector<RivalSignal> setpoints_;           // per CV
  std::vector<std::vector<int>> noise_before_;   // likewise
};

}  // namespace mpm
