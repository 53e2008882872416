#include "core/identification/identification_data.hpp"

#include <cmath>

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

double mean_of_known(const Eigen::Ref<const VectorXd>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value, count += 1.0;
  return count > 0.0 ? sum / count : 0.0;
}

/// The last known value where one is missing; in the rows before the first, that one.
void hold(Eigen::Ref<VectorXd> values, double otherwise) {
  Index first = 0;
  while (first < values.size() && !std::isfinite(values(first))) ++first;
  double last = first < values.size() ? values(first) : otherwise;
  for (double& value : values) {
    if (std::isfinite(value)) last = value;
    value = last;
  }
}

}  // namespace

IdentificationData identification_data(const Recording& recording) {
  IdentificationData data;
  data.sample_time_s = recording.sample_time_s;
  data.runs = runs_of(recording);
  data.borders = recording.borders;
  data.inputs = recording.inputs;
  data.input_mean.resize(recording.inputs.cols());
  for (Index i = 0; i < data.inputs.cols(); ++i) {
    data.input_mean(i) = mean_of_known(recording.inputs.col(i));
    for (const Run& run : data.runs)
      hold(data.inputs.col(i).segment(run.first, run.count), data.input_mean(i));
    data.inputs.col(i).array() -= data.input_mean(i);
  }
  data.cvs = recording.cvs;
  data.cv_mean.resize(recording.cvs.cols());
  data.known.resize(recording.cvs.rows(), recording.cvs.cols());
  for (Index j = 0; j < data.cvs.cols(); ++j) {
    data.cv_mean(j) = mean_of_known(recording.cvs.col(j));
    for (Index k = 0; k < data.cvs.rows(); ++k) {
      const bool known = std::isfinite(recording.cvs(k, j));
      data.known(k, j) = known ? 1.0 : 0.0;
      data.cvs(k, j) = known ? recording.cvs(k, j) - data.cv_mean(j) : 0.0;
    }
  }
  return data;
}

double spread_of(const Eigen::Ref<const VectorXd>& values,
                 const Eigen::Ref<const VectorXd>& known) {
  const double count = known.sum();
  if (!(count > 0.0)) return 0.0;
  const double mean = values.dot(known) / count;
  return std::sqrt(((values.array() - mean).square() * known.array()).sum() / count);
}

}  // namespace mpm
