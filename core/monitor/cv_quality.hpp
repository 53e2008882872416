#pragma once

#include <algorithm>
#include <cstdint>

#include "core/monitor/calibration.hpp"

namespace mpm {

/// How good one CV's data have been lately: shares of samples, exponentially weighted.
class CvQuality {
 public:
  /// What is known of a sample.
  struct Sample {
    bool known = false;        ///< it has a residual
    bool implausible = false;  ///< an instrument falsified the measurement or the prediction
    bool took_row = false;     ///< it gave the regression a row
    std::uint64_t spikes = 0;  ///< of this CV so far
  };
  /// `samples`: taken so far, this one included.
  void take(const Sample& sample, std::int64_t samples) {
    constexpr double kShareStep = 1.0 / calibration::bad_data::kShareSamples;
    constexpr double kImplausibleStep = 1.0 / calibration::bad_data::kImplausibleSamples;
    const auto one_if = [](bool value) { return value ? 1.0 : 0.0; };
    implausible_share_ += kImplausibleStep * (one_if(sample.implausible) - implausible_share_);
    spike_share_ += std::max(kImplausibleStep, 1.0 / static_cast<double>(samples)) *
                    (one_if(sample.spikes > spikes_) - spike_share_);
    spikes_ = sample.spikes;
    unknown_share_ += kShareStep * (one_if(!sample.known) - unknown_share_);
    without_row_ = sample.took_row ? 0 : without_row_ + 1;
  }

  /// Too many values look like none that a process gives.
  [[nodiscard]] bool implausible() const {
    return implausible_share_ > calibration::bad_data::kImplausibleShare ||
           spike_share_ > calibration::bad_data::kSpikyShare;
  }
  [[nodiscard]] bool mostly_unknown() const {
    return unknown_share_ > calibration::bad_data::kMostShare;
  }
  /// Samples in a row that gave none.
  [[nodiscard]] std::int64_t without_row() const { return without_row_; }
  template <class Archive>
  void archive(Archive& a) {
    a(implausible_share_, spike_share_, unknown_share_, spikes_, without_row_);
  }

 private:
  double implausible_share_ = 0.0, spike_share_ = 0.0, unknown_share_ = 0.0;
  std::uint64_t spikes_ = 0;
  std::int64_t without_row_ = 0;
};

}  // namespace mpm
