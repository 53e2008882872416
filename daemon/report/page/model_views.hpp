#pragma once

#include <string>
#include <vector>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

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
  std::vector<double> low, high;  ///< 95 % of Diagnosis::channels; empty where not estimated
};

/// Every channel that leads to `cv` in either model.
[[nodiscard]] std::vector<StepView> step_views(const DiagnosisRun& run, int cv);

/// y over x at rest, or while x goes slowly up and down again.
struct CurveView {
  std::string title, x_label, y_label;
  std::vector<double> x, before, after;
};

/// Of every static block and of every channel with a nonlinear state in which the models differ.
[[nodiscard]] std::vector<CurveView> curve_views(const DiagnosisRun& run);

}  // namespace mpm::report
