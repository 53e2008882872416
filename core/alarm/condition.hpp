#pragma once

#include <algorithm>
#include <array>

#include "core/text/words.hpp"

namespace mpm {

enum class AlarmState : unsigned char { kCleared, kActive };

[[nodiscard]] constexpr auto words_of(AlarmState) { return std::array{"cleared", "active"}; }

/// One alarm condition on a p-value: raised once it has stayed below `raise_below` for
/// `on_delay` samples in a row, cleared once it has stayed above `clear_above` for `off_delay`
/// samples in a row. Between the two limits (the deadband) and while there is no verdict nothing
/// changes and the counts start anew: silence neither raises nor clears.
class Condition {
 public:
  struct Limits {
    double raise_below = 0.0;  ///< p-value
    double clear_above = 1.0;  ///< p-value, >= raise_below
    int on_delay = 1;          ///< samples, >= 1
    int off_delay = 1;         ///< samples, >= 1
  };

  /// Takes one sample's p-value; true where the state changed.
  bool update(double p_value, const Limits& limits) {
    const bool toward = state_ == AlarmState::kCleared ? p_value < limits.raise_below
                                                       : p_value > limits.clear_above;
    held_ = toward ? held_ + 1 : 0;
    const int delay = state_ == AlarmState::kCleared ? limits.on_delay : limits.off_delay;
    if (held_ < std::max(delay, 1)) return false;
    state_ = state_ == AlarmState::kCleared ? AlarmState::kActive : AlarmState::kCleared;
    held_ = 0;
    return true;
  }
  /// Decided elsewhere.
  void set(AlarmState state) {
    state_ = state;
    held_ = 0;
  }
  /// A sample without a verdict.
  void hold() { held_ = 0; }

  template <class Archive>
  void archive(Archive& a) {
    a.within(state_, AlarmState::kCleared, AlarmState::kActive);
    a(held_);
  }

  [[nodiscard]] AlarmState state() const { return state_; }

 private:
  AlarmState state_ = AlarmState::kCleared;
  int held_ = 0;
};

}  // namespace mpm
