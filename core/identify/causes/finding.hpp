#pragma once

#include <optional>
#include <string>
#include <vector>

/// What `diagnose` names: causes of a difference between a plant and its simulation.
namespace mpm {

enum class Cause {
  kGain,
  kDeadTime,
  kTimeConstant,
  kDynamics,  ///< two or more of the three above in one channel
  kInputScale,
  kOutputScale,
  kInputNonlinearity,
  kStiction,
  kOutputNonlinearity,
  kUnmodelledInput,
  kOutputDisturbance,
  kNoise,
  kStateNonlinearity,
  kUnnamed,  ///< something no cause above means: never in a finding
};

/// As the reports say it: `gain`, `dead_time`, ...
[[nodiscard]] const char* name_of(Cause cause);

/// A fitted number with its 95 % interval. Names and units as in the contract: `gain_ratio`,
/// `dead_time_error` (s), `time_constant_ratio`, `band`, `jump` (input units), `size` (CV units)
/// ...
struct Parameter {
  std::string name;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// What a cause is about; -1 where a kind of signal plays no part.
struct Subject {
  Cause cause = Cause::kGain;
  int cv = -1;
  int input = -1;    ///< MV or DV
  int aux = -1;      ///< the measured signal that the model leaves out
  std::string kind;  ///< of a nonlinearity, shape of a disturbance, term of a state; else empty

  [[nodiscard]] bool operator==(const Subject&) const = default;
};

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
};

}  // namespace mpm
