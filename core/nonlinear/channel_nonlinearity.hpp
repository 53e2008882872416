#pragma once

#include <array>
#include <cstdint>

#include "core/text/words.hpp"

namespace mpm {

/// How a unit is asked whether it answers as no linear model does.
enum class NonlinearTest : std::uint8_t {
  kOff,
  kPolynomial,      ///< squares, cubes and products
  kKernel,          ///< principal components of a Gaussian kernel's part, beside the squares
  kRandomFeatures,  ///< random Fourier features of that kernel, likewise
};

enum class NonlinearVerdict : std::uint8_t { kUndetermined, kLinear, kNonlinear };

/// Which of the columns tell most where a channel is nonlinear.
enum class NonlinearKind : std::uint8_t {
  kNone,
  kInputCurve,    ///< a function of the input, before the channel's dynamics
  kHysteresis,    ///< a play: where the input came from counts
  kChannelCurve,  ///< a function of what the channel gives
  kInteraction,   ///< of that and of what another channel gives
  kOutputCurve,   ///< of what all channels give together
};

[[nodiscard]] constexpr auto words_of(NonlinearVerdict) {
  return std::array{"undetermined", "linear", "nonlinear"};
}
[[nodiscard]] constexpr auto words_of(NonlinearKind) {
  return std::array{
      "", "input_curve", "hysteresis", "channel_curve", "interaction", "output_curve"};
}

/// What the data say of one channel's nonlinearity, beside whatever linear errors it has.
struct ChannelNonlinearity {
  bool tested = false;  ///< the unit is asked at all
  NonlinearVerdict verdict = NonlinearVerdict::kUndetermined;
  NonlinearKind kind = NonlinearKind::kNone;  ///< of a nonlinear one
  double p_value = 1.0;                       ///< that it is linear, 0..1
  double statistic = 0.0;                     ///< its F
  /// Variance of what it explains, beyond chance, per variance of the one-step errors, >= 0.
  double share = 0.0;
  bool material = false;  ///< it matters, and is more than what linear errors leave
  /// Two s.d. of the local gain of the weakest square in front of the channel that would have been
  /// seen, relative to the model's; no more than 100 is said.
  double smallest_variation = kMostVariation;
  static constexpr double kMostVariation = 100.0;

  /// See FieldKey.
  template <class Archive>
  void archive(Archive& a) {
    a.within(verdict, NonlinearVerdict::kUndetermined, NonlinearVerdict::kNonlinear);
    a.within(kind, NonlinearKind::kNone, NonlinearKind::kOutputCurve);
    a(tested, p_value, statistic, share, material, smallest_variation);
  }
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit({"tested", false}, record.tested, sample.tested...);
    visit("verdict", record.verdict, sample.verdict...);
    visit({"kind", record.kind != NonlinearKind::kNone}, record.kind, sample.kind...);
    visit("p_value", record.p_value, sample.p_value...);
    visit("statistic", record.statistic, sample.statistic...);
    visit("share", record.share, sample.share...);
    visit("material", record.material, sample.material...);
    visit("smallest_variation", record.smallest_variation, sample.smallest_variation...);
  }
};

}  // namespace mpm
