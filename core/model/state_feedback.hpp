#pragma once

#include "core/model/channel_facts.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// phi of a `StateTerm`: what one channel's output takes off its input. Below an empty vessel the
/// square root goes on with the other sign (what is pumped out flows back), so that every held
/// input has a rest.
class StateFeedback {
 public:
  /// `facts` are those of the channel's linear part. Throws std::invalid_argument where a parameter
  /// makes no sense.
  StateFeedback(const StateBlock& block, const ChannelFacts& facts, double output_origin,
                double sample_time_s);

  /// From the channel's deviation y(k) and y(k-1), input units.
  [[nodiscard]] double value(double output, double previous) const;
  /// The deviation at which the channel rests under a held input: y = gain (input - phi(y)), the
  /// first one on the way from the operating point; where there is none, the point at which it
  /// begins to run away. An integrating channel rests where it is.
  [[nodiscard]] double rest(double input) const;

 private:
  [[nodiscard]] double restoring_rest(const RestoringForce& force, double input) const;

  StateBlock block_;
  double gain_;
  bool integrating_;
  double height_ = 0.0;  ///< of the operating point above empty, CV units
  double step_ = 0.0;    ///< CV units per sample at which friction is nearly full
};

}  // namespace mpm
