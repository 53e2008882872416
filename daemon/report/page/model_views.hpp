#pragma once

#include <string>
#include <vector>

#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/page/channel_numbers.hpp"

/// What a model does, for comparing the unit file's with the extended one.
namespace mpm::report {

/// Answer of one CV to a step of one input from the operating point, per unit of the input.
struct StepView {
  int cv = 0;
  int input = 0;
  double size = 1.0;           ///< of the step, input units: what is usual in the data
  double spacing_s = 1.0;      ///< between the values
  std::vector<double> before;  ///< all zero where the model has no such channel
  std::vector<double> after;
  /// All that the 95 % intervals of the channel's numbers allow, `after` among it; empty where
  /// there are none.
  std::vector<double> low, high;
};

[[nodiscard]] StepView step_view(const DiagnosisRun& run, const ChannelNumbers& channel);

/// What the linear part sees, in input units, of a command's values in a row, through the static
/// block of the channel (`cv` < 0: of the input).
[[nodiscard]] std::vector<double> seen_of_command(const ModelSpec& spec, int cv, int input,
                                                  const std::vector<double>& command);

/// y over x at rest, or while x goes slowly up and down again.
struct CurveView {
  int cv = -1;     ///< -1: what the input does to all of them
  int input = -1;  ///< -1: a curve of the CV alone
  std::string title, x_label, y_label;
  std::vector<double> x, before, after;
};

/// Of every static block and of every channel with a nonlinear state in which the models differ.
[[nodiscard]] std::vector<CurveView> curve_views(const DiagnosisRun& run);

}  // namespace mpm::report
