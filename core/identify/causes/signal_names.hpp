#pragma once

#include <string>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

struct SignalName {
  std::string tag;
  std::string unit;  ///< engineering unit; may be empty
};

/// Tags, engineering units and the model's gains for the indices of a diagnosis.
struct SignalNames {
  std::vector<SignalName> inputs;  ///< MVs, DVs, then the aux signals that the extended model takes
  std::vector<SignalName> aux;
  std::vector<SignalName> cvs;
  ModelSpec model = {};  ///< the one that was diagnosed

  [[nodiscard]] const SignalName& input(int index) const;
  [[nodiscard]] const SignalName& cv(int index) const;
  /// What acts: an input or an aux signal; both empty where nothing does.
  [[nodiscard]] const SignalName& source(const Place& place) const;
  /// "gain of u1 -> y1", "output_disturbance (step) on y2"
  [[nodiscard]] std::string subject(const Subject& subject) const;

  /// "0.25 %": a number with the unit of the signal, as far as one is known.
  [[nodiscard]] std::string in_cv(double value, int cv) const;
  [[nodiscard]] std::string in_source(double value, const Place& place) const;
  /// The unit itself; "x model" of a ratio, empty where none is known.
  [[nodiscard]] std::string unit_text(Unit unit, const Place& place) const;
  /// The model's gain of a channel and the plant's, if that is so many times as large, where the
  /// channel settles: "gain 3.04 instead of 4.05 K per %; ". Else empty.
  [[nodiscard]] std::string gains(const Place& place, double ratio) const;
};

/// "95 % interval 0.72 to 0.78"
[[nodiscard]] std::string interval_of(const Parameter& parameter, const std::string& unit = {});
/// "25 % less", "30 % more", "in the opposite direction and 2 times as much"
[[nodiscard]] std::string compared(double ratio);

}  // namespace mpm
