#pragma once

#include <array>
#include <cstddef>

#include "core/signal/calibration.hpp"

namespace mpm {

class Archive;

/// How far one signal has ever ranged, in plausible values. The first ones are judged together, in
/// hindsight.
class Extent {
 public:
  /// What the first values turn out to be, told with the last of them.
  struct Verdict {
    bool wild = false;  ///< some were an excursion, which does not count
    int out = 0;        ///< the last so many are one that is not over, and do not count yet
  };

  /// Takes a plausible value.
  Verdict learn(double value);

  /// So many of the first values must have come.
  [[nodiscard]] bool known() const { return taken_ == kFirst; }
  /// High minus low, signal units; 0 where that is no more than the signal's last digits.
  [[nodiscard]] double width() const;
  /// How far a value lies outside, signal units: 0 inside.
  [[nodiscard]] double outside(double value) const;
  /// The same in widths: infinite outside where the width is 0.
  [[nodiscard]] double beyond(double value) const;
  /// Whether a value is back from where the one before it was.
  [[nodiscard]] bool back(double value, double before) const;

  void archive(Archive& a);

 private:
  static constexpr std::size_t kFirst = calibration::extent::kFirstValues;

  [[nodiscard]] Verdict judge_first();

  double low_ = 0.0, high_ = 0.0;
  std::size_t taken_ = 0;  // of the first
  std::array<double, kFirst> first_{};
};

}  // namespace mpm
