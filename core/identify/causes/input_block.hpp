#pragma once

#include <string>
#include <vector>

#include "core/identify/causes/cause.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/spread.hpp"

namespace mpm {

/// s.d. of what bends an input adds where that, or what it goes with, is farthest from the
/// operating point, as a share of the straight part.
inline constexpr double kBend = 0.3;

inline constexpr CauseName kInputNonlinearity{"input_nonlinearity", "Nonlinear input"};

/// Where a static block may sit: before all of an input's channels, or before one of several.
struct BlockPlace {
  Place place;          ///< cv -1: before all of them
  Spread input;         ///< how the input moves
  bool whole_input;     ///< it acts on all CVs of the input
  std::size_t members;  ///< places there are in the model
};

/// A cause that puts a static block before an input's channels. An input has one, but for an
/// actuator's offset, which may stand before a curve: what a valve lets through too much bends as
/// the rest does.
class InputBlockCause : public Cause {
 public:
  using Cause::Cause;
  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override;
  [[nodiscard]] bool is_input_block() const override { return true; }
  [[nodiscard]] bool goes_with(const Effect& accepted, const Effect& mine) const override;

 protected:
  [[nodiscard]] virtual InputBlock block(const Effect& effect,
                                         const Surroundings& surroundings) const = 0;
  /// Clock of the data at the effect's onset, s; minus infinity where it is in force throughout.
  [[nodiscard]] static double since_s(const Effect& effect, const Surroundings& surroundings);
  /// Whether it may be looked for where the model has this block.
  [[nodiscard]] virtual bool may_stand_beside(const InputBlock& there) const;
  /// Where nothing is in the way of a block.
  [[nodiscard]] std::vector<BlockPlace> block_places(const Outlook& outlook) const;
  /// Of these, where the input has been at so many levels: on fewer a curve through them is a
  /// straight line with an offset, and nothing tells them apart.
  [[nodiscard]] std::vector<BlockPlace> curve_places(const Outlook& outlook, int levels = 3) const;
  /// From the start, and from where the calibrated test sees a change, if it does: elsewhere a
  /// valve's many starts would take too long.
  [[nodiscard]] static std::vector<ErrorOnset> block_onsets(const Outlook& outlook);
  /// A gain to the model's, not in its logarithm.
  [[nodiscard]] static Coordinate plain_ratio(const Quantity& quantity);
  /// A number that bends what is straight.
  [[nodiscard]] static Coordinate bending(const Quantity& quantity, double sd);
  /// One number before several: all gains of the input are off, by so much, and nothing is bent.
  [[nodiscard]] static std::vector<Rewrite> as_gain(std::size_t mine,
                                                    const std::vector<Effect>& accepted,
                                                    double ratio, const Problem& problem);
  /// The one CV that the model has this input act on; -1 where there are several.
  [[nodiscard]] static int only_cv(const ModelSpec& model, int input);
  /// The tag of what the block stands before: a CV's, or "the plant".
  [[nodiscard]] static std::string target(const Finding& finding, const SignalNames& names);
};

}  // namespace mpm
