#pragma once

#include <string>

#include "core/identify/causes/cause.hpp"

namespace mpm {

inline constexpr CauseName kOutputDisturbance{"output_disturbance", "Disturbance or sensor offset",
                                              "shape"};

inline constexpr Quantity kSize{"size", Form::kPlain, Unit::kCv};

/// A disturbance, or an offset of the sensor: the data cannot tell the two apart. Any number of
/// them may be there.
class OutputDisturbance : public Cause {
 public:
  explicit OutputDisturbance(const char* shape) : Cause(kOutputDisturbance, shape) {}
  [[nodiscard]] bool goes_with(const Effect& accepted, const Effect& mine) const override;
  [[nodiscard]] bool acts_through_channels() const override { return false; }
  [[nodiscard]] bool has_onset_parameter() const override { return true; }
  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override;

 protected:
  /// "is shifted down by 3 K", without CV and full stop.
  [[nodiscard]] virtual std::string what_it_does(const Finding& finding,
                                                 const SignalNames& names) const = 0;
  /// "up by 3 K"; "up" where the size is not known.
  [[nodiscard]] static std::string up_or_down(const Finding& finding, const SignalNames& names);
  /// " by 3 K", without a sign; empty where the size is not known.
  [[nodiscard]] static std::string by_size(const Finding& finding, const SignalNames& names);
  /// s.d. of what is left of a CV without the disturbance; > 0.
  [[nodiscard]] static double left_sd(const CvFit& without);
  /// Clock of the data at the effect's onset, s.
  [[nodiscard]] static double onset_s(const Effect& effect, const Surroundings& surroundings);
};

namespace causes {
/// A constant offset of a CV, throughout the data, as a step.
[[nodiscard]] Effect constant_offset(int cv, double level, double noise_sd);
[[nodiscard]] bool is_constant_offset(const Effect& effect);
/// A drift, a step, a cycle of one CV: a function of time alone that is more than a level.
[[nodiscard]] bool is_break(const Effect& effect);
/// How many of these are such, of that CV.
[[nodiscard]] std::size_t breaks_of(const std::vector<Effect>& effects, int cv);
/// A step that comes back by itself.
[[nodiscard]] bool passes(const Effect& effect);
}  // namespace causes

}  // namespace mpm
