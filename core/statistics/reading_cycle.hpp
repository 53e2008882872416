#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/statistics/calibration.hpp"

namespace mpm {

class Archive;

/// Whether a signal is read only every so many samples (an analyser's), between which its last
/// reading stands or nothing comes, and which of its values are readings: `reading_interval` while
/// they come. The cycle need be no multiple of a sample. No allocation.
class ReadingCycle {
 public:
  struct Reading {
    double value = 0.0;
    std::int64_t cycles = 1;  ///< since the last one
  };

  /// Takes the value of an interval, NaN where unknown; intervals increase. The reading that it is,
  /// of a signal that is known to be read seldom.
  std::optional<Reading> take(std::int64_t interval, double value);

  /// From one reading to the next, samples, > 1; 0 = it is read at every sample, or in no cycle.
  [[nodiscard]] double samples() const { return samples_; }
  /// Samples since the last reading, of a signal that is read seldom.
  [[nodiscard]] double elapsed(std::int64_t interval) const {
    return static_cast<double>(interval) - read_ - static_cast<double>(assumed_) * samples_;
  }

  void archive(Archive& a);

 private:
  void look_at_spacings();

  // Spacings of its last changes, intervals, and where the next one is put.
  std::array<std::int64_t, readings::kRemembered> spacings_{};
  std::size_t count_ = 0, next_ = 0;
  double last_ = std::numeric_limits<double>::quiet_NaN();
  std::int64_t changed_ = 0;
  double samples_ = 0.0;
  double read_ = 0.0;         // interval of the last reading that was another than the one before
  std::int64_t assumed_ = 0;  // readings since
};

}  // namespace mpm
