#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/place.hpp"
#include "core/alarm/alarm_settings.hpp"
#include "core/identification/channel_hint.hpp"
#include "core/model/model_spec.hpp"
#include "core/monitor/settings.hpp"
#include "core/performance/signal_limits.hpp"
#include "core/signal/frame.hpp"

/// The unit file as plain structs: the schema. Loading and checking is in `load_unit.hpp`.
namespace mpm::config {

struct InputSignal {
  std::string tag;
  std::string unit;  ///< engineering unit, for display
  std::string description;
  /// Hard ones of an MV, what the instrument of a DV gives; signal units. None of other signals.
  SignalLimits limits = {};
};

struct CvSignal {
  std::string tag;
  std::string unit;
  std::string description;
  std::string prediction;    ///< tag; empty = simulate from the model
  std::string setpoint;      ///< tag; may be empty
  SignalLimits limits = {};  ///< soft, CV units
};

/// A tag whose values are computed from those of others.
struct CalculatedSignal {
  std::string tag;
  std::string expression;           ///< as `Formula` reads it
  std::string unit;                 ///< engineering unit; may be empty
  std::vector<std::string> inputs;  ///< tags in the expression, each once, in its order
};

/// The UDP ports of a greater one would be beyond 65535. Options and permissions have it, too.
inline constexpr int kHighestDomain = 230;

struct DdsSettings {
  int domain = 0;                  ///< 0..kHighestDomain
  std::string interface = "lo";    ///< network interface by name; empty = Cyclone's choice
  std::vector<std::string> peers;  ///< host addresses beside 127.0.0.1
  bool multicast = false;
  std::string partition;      ///< discovery tag that keeps plants apart; may be empty
  int max_participants = 60;  ///< processes of one domain on one host without multicast
  std::string security;       ///< folder of keys, absolute; empty = no DDS Security
  Place security_at;          ///< who says so
};

/// Noise on one CV: w(k) white with `sigma`, v(k) = w(k) / prod(1 - pole z^-1).
struct NoiseSettings {
  double sigma = 0.0;  ///< CV units
  double pole = 0.95;  ///< 0 <= pole < 1
};

struct MvLimits {
  std::optional<double> low, high;  ///< hard, MV units
  std::optional<double> max_move;   ///< hard, MV units per sample
};

struct CvLimits {
  std::optional<double> low, high;  ///< soft, CV units
};

/// Reference signal: random binary, redrawn every `hold` samples, phases staggered over the CVs.
struct SetpointSettings {
  double amplitude = 0.5;  ///< CV units around the operating point
  int hold_samples = 100;
};

/// The simulated controller and disturbances; used by mpmsim only.
struct SimulationSettings {
  /// The plant's own equations by name, such as `recovery_boiler`; empty = the unit's model.
  std::string process;
  int prediction_horizon = 100;                      ///< samples
  std::vector<int> move_blocks = {5, 5, 5, 10, 25};  ///< samples; the last one holds on
  std::vector<double> cv_weights;                    ///< one per CV; empty = 1
  std::vector<double> move_weights;                  ///< one per MV; empty = 1
  double soft_limit_weight = 1000.0;                 ///< linear cost per CV unit of violation
  std::vector<MvLimits> mv_limits;                   ///< one per MV
  std::vector<CvLimits> cv_limits;                   ///< one per CV
  std::vector<NoiseSettings> noise;                  ///< one per CV
  std::vector<NoiseSettings> dv_movement;   ///< one per DV: how measured disturbances wander
  std::vector<NoiseSettings> aux_movement;  ///< one per aux signal, around 0
  std::vector<SetpointSettings> setpoints;  ///< one per CV
};

struct UnitConfig {
  std::string unit;  ///< name and DDS key
  double sample_time_s = 1.0;
  std::vector<InputSignal> mv, dv, aux;
  std::vector<CvSignal> cv;
  std::vector<InputSignal> raw;        ///< measured, only to calculate with
  std::vector<CalculatedSignal> calc;  ///< each behind those that it uses
  ModelSpec model;
  MonitorSettings monitor;
  AlarmSettings alarms;
  AlarmHandling alarm_handling;
  DdsSettings dds;
  SimulationSettings simulation;
  std::vector<ChannelHint> identify;  ///< what `mpm identify` is told beforehand

  [[nodiscard]] SignalCounts counts() const {
    return {static_cast<int>(mv.size()), static_cast<int>(dv.size()), static_cast<int>(cv.size()),
            static_cast<int>(aux.size()), static_cast<int>(raw.size())};
  }
  /// The limits that count: those beside the signal or, where it has none there, those of
  /// `simulation`.
  [[nodiscard]] SignalLimits mv_limits(std::size_t index) const {
    return limits_of(mv[index], simulation.mv_limits, index);
  }
  [[nodiscard]] SignalLimits cv_limits(std::size_t index) const {
    return limits_of(cv[index], simulation.cv_limits, index);
  }
  /// How this tag is calculated; null for one that is measured.
  [[nodiscard]] const CalculatedSignal* calculation_of(std::string_view tag) const {
    for (const CalculatedSignal& signal : calc)
      if (signal.tag == tag) return &signal;
    return nullptr;
  }
  /// Tag of model input `index`: MVs first, then DVs.
  [[nodiscard]] const std::string& input_tag(int index) const {
    const auto i = static_cast<std::size_t>(index);
    return i < mv.size() ? mv[i].tag : dv[i - mv.size()].tag;
  }
  /// Tag of what moves a unit: the model's inputs, then the CVs' set-points, then auxiliary
  /// signals.
  [[nodiscard]] const std::string& mover_tag(int index) const {
    auto i = static_cast<std::size_t>(index);
    if (i < mv.size() + dv.size()) return input_tag(index);
    i -= mv.size() + dv.size();
    return i < cv.size() ? cv[i].setpoint : aux[i - cv.size()].tag;
  }
  /// Tags of the model's inputs, MVs first, and of the CVs.
  [[nodiscard]] std::vector<std::string> input_tags() const {
    std::vector<std::string> tags;
    for (const InputSignal& signal : mv) tags.push_back(signal.tag);
    for (const InputSignal& signal : dv) tags.push_back(signal.tag);
    return tags;
  }
  [[nodiscard]] std::vector<std::string> cv_tags() const {
    std::vector<std::string> tags;
    for (const CvSignal& signal : cv) tags.push_back(signal.tag);
    return tags;
  }
  /// True where predictions can be simulated.
  [[nodiscard]] bool has_model() const {
    return !model.channels.empty() || model.state_space.has_value();
  }

 private:
  [[nodiscard]] static SignalLimits limits_of(const auto& signal, const auto& simulated,
                                              std::size_t index) {
    if (signal.limits.known() || index >= simulated.size()) return signal.limits;
    return {simulated[index].low, simulated[index].high};
  }
};

}  // namespace mpm::config
