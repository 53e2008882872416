#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identify/fit/effect.hpp"

/// What `diagnose` names: causes of a difference between a plant and its simulation.
namespace mpm {

class Cause;

/// A name of the contract, which several kinds of a cause may share. Equal if the same object.
struct CauseName {
  const char* text;               ///< "gain"
  const char* title;              ///< "Gain": a headline
  const char* kind_key = "kind";  ///< what the contract calls the word for the kind
};

/// What a finding is about.
struct Subject {
  const Cause* cause = nullptr;  ///< never null in a finding
  Place place = {};

  [[nodiscard]] bool operator==(const Subject&) const = default;
};

/// A fitted number with its 95 % interval, in the unit that its quantity names.
struct Parameter {
  const Quantity* quantity = nullptr;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  int number = 0;  ///< from 1 where a finding has several of its quantity

  /// As the reports say it: `gain_ratio`, `overflow_1`.
  [[nodiscard]] std::string name() const;
};

/// Whether the interval of a ratio includes 1, of any other number 0.
[[nodiscard]] bool includes_nothing(const Parameter& parameter);

/// Another explanation of the same difference.
struct Rival {
  Subject subject;
  double worse = 0.0;        ///< -2 ln of its odds against the finding's cause
  bool inseparable = false;  ///< the data do not decide between the two
};

struct Finding {
  Subject subject;
  std::vector<Parameter> parameters;
  double confidence = 0.0;        ///< 0..1, posterior probability among all causes considered
  double evidence = 0.0;          ///< 2 ln odds against the same model without it
  std::optional<double> onset_s;  ///< clock of the data; where it began inside the data
  std::vector<Rival> rivals;      ///< closest first
  bool repaired = true;           ///< the extended model holds it, and is the better for it
  std::string refused;            ///< why the extended model does not, for a person; else empty
  bool late = false;              ///< fitted on all samples: it began too late for the first part
  /// Another finding without which the extended model would not hold it.
  std::optional<Subject> with;
  /// Share of the mean square error on unseen samples of the CVs it acts on that goes with it; may
  /// be negative.
  double explains = 0.0;
  int other_input = -1;  ///< that it depends on too; -1: on none

  [[nodiscard]] const Parameter* find(const Quantity& quantity) const;
};

}  // namespace mpm
