#pragma once

#include <optional>

#include "core/model/model_spec.hpp"

namespace mpm {

class Archive;

/// Index of the input that a product goes with; -1 where there is none.
[[nodiscard]] int other_input(const std::optional<InputBlock>& block);

/// The static (or friction) element in front of one input of the linear part. Takes the input in
/// its own units and gives the deviation from the origin that the linear part sees.
///
/// Deadband is the play operator: p(k) = clamp(p(k-1), u(k) - w/2, u(k) + w/2), so after a reversal
/// the output follows only once the input has moved back by w.
///
/// Stiction is the two-parameter valve of Choudhury, Thornhill and Shah (2005) written with its two
/// friction limits: static (S+J)/2 and moving (S-J)/2. A sticking valve v slips to
/// v = u - sign(u - v) (S-J)/2 once |u - v| > (S+J)/2; it moves on so while the input keeps its
/// direction and sticks again when the input stops or turns. Seen from the command this is a wait
/// of S after a reversal (J after a stop) and then a jump by J. From a reset the valve sits at the
/// input.
///
/// A product goes with another input, whose deviation from its origin `apply` is given.
///
/// A stuck input and an offset one are in force from their onset on: time goes by the clock of the
/// data.
class InputElement {
 public:
  /// Throws std::invalid_argument where a parameter makes no sense.
  InputElement(std::optional<InputBlock> block, double origin);

  [[nodiscard]] int other() const { return other_input(block_); }

  /// As if `input` had been held for ever.
  void reset(double input);
  /// `time_s`: when the input is given, with whatever rounding may take from it.
  [[nodiscard]] double apply(double input, double time_s, double other_deviation = 0.0);

  void archive(Archive& a);

 private:
  [[nodiscard]] double apply_stiction(const Stiction& valve, double input);

  std::optional<InputBlock> block_;
  double origin_;
  double position_ = 0.0;  ///< of the play or the valve, input units
  double last_input_ = 0.0;
  int direction_ = 0;  ///< of a moving valve; 0 = sticking
};

/// The static element behind one CV: `deviation` from the origin to the CV in its own units.
/// Saturation clips the CV, an offset is added to it, a scale acts on the deviation.
[[nodiscard]] double apply_output_block(const std::optional<OutputBlock>& block, double origin,
                                        double deviation);

/// Throws std::invalid_argument where a parameter makes no sense.
void check_output_block(const OutputBlock& block);

}  // namespace mpm
