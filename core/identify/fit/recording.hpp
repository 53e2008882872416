#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/model/model_spec.hpp"

namespace mpm {

/// Where a recording's next run begins.
struct Border {
  Eigen::Index row = 0;  ///< first of the run, > 0
  /// By how much the clock of the data is further there than the rows counted from the recording's
  /// start; of either sign, for runs need not be in the order of time.
  double ahead_s = 0.0;

  [[nodiscard]] bool operator==(const Border&) const = default;
};

/// A valve whose position is measured, and sticks.
struct MeasuredSticking {
  int input = -1;  ///< whose command it follows
  int aux = -1;    ///< its position
  Stiction valve;
};

/// Measurements on the model's sample grid, one row per sample, NaN where a value is not known.
/// Row convention as in `Frame`: y(k) was measured, then u(k) was applied and acts until k+1.
/// One run, or several: at a border nobody knows what happened since the row before, so each run
/// has a first state and a level of its own, and nothing is simulated or whitened across it. What
/// acts from some row on counts time by rows, as if there were no borders.
struct Recording {
  double start_s = 0.0;              ///< of the first row, on the clock of the data
  double sample_time_s = 1.0;        ///< > 0
  Eigen::MatrixXd inputs;            ///< samples x model inputs (MVs, then DVs), own units
  Eigen::MatrixXd cvs;               ///< samples x CVs, CV units
  Eigen::MatrixXd aux;               ///< samples x measured signals that the model does not use
  std::vector<Border> borders = {};  ///< ascending; none where there is one run
  /// Samples x CVs, CV units; a column of NaN for a CV without one, or no columns at all.
  Eigen::MatrixXd setpoints = {};
  /// Row from which on some channel was seen to do something else (`change_row`).
  std::optional<Eigen::Index> changed = std::nullopt;
  /// Per CV those whose noise goes before its own (`ChannelTests`); nothing where nobody has asked.
  std::vector<std::vector<int>> noise_before = {};
  /// What the measured positions of valves show (`measured_sticking`).
  std::vector<MeasuredSticking> sticking = {};

  [[nodiscard]] Eigen::Index samples() const { return cvs.rows(); }
};

/// The same with the set-points as measured signals behind the aux ones: what moves with a
/// set-point is no error of a channel.
[[nodiscard]] Recording with_setpoints(const Recording& recording);
/// Where they begin among the aux signals of such a recording.
[[nodiscard]] inline Eigen::Index first_setpoint(const Recording& recording) {
  return recording.aux.cols() - recording.setpoints.cols();
}

/// Rows of a recording that belong together.
struct Run {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};

/// All runs of a recording, in order: at least one.
[[nodiscard]] std::vector<Run> runs_of(const Recording& recording);

/// A moment counted by rows (`start_s` + row * `sample_time_s`) on the clock of the data.
[[nodiscard]] double on_clock(const Recording& recording, double time_s);

/// Some rows of a recording, on the same clock.
[[nodiscard]] Recording part(const Recording& recording, Eigen::Index first, Eigen::Index count);

/// One recording after the other, each a run (or several) of the result; the same signals and
/// sample time in all. `recordings` must not be empty.
[[nodiscard]] Recording joined(const std::vector<Recording>& recordings);

}  // namespace mpm
