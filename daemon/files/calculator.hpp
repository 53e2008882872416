#pragma once

#include <optional>
#include <vector>

#include "config/formula.hpp"
#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::files {

/// Computes a unit's calculated signals in each of its frames, wherever those come from: the rows
/// of a file, or the samples of a bus once they are aligned.
class Calculator {
 public:
  explicit Calculator(const config::UnitConfig& unit);

  /// Gives every calculated signal its value. Its quality is the worst of those of its inputs at
  /// this interval; where one is bad or the result is not finite it is bad and has no value.
  /// Whatever stood in its place is overwritten. Allocates nothing.
  void fill(Frame& frame);

 private:
  struct Value {
    double value = 0.0;
    Quality quality = Quality::kBad;
  };
  /// A measured signal of the frame, or a calculation before this one.
  struct Source {
    SignalKind kind = SignalKind::kMv;
    int index = 0;
    std::optional<std::size_t> calculation;
  };
  struct Place {
    SignalKind kind = SignalKind::kMv;
    int index = 0;
  };
  struct Step {
    config::Formula formula;
    std::vector<Source> inputs;  // of formula.tags()
    std::vector<double> values;  // theirs
    std::optional<Place> place;  // of the result, where a signal is called so
    Value result;
  };

  [[nodiscard]] Value value_of(const Source& source, const Frame& frame) const;

  std::vector<Step> steps_;
};

}  // namespace mpm::files
