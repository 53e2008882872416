#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/fit/readings.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

/// CVs that are read only every so many samples (an analyser's) are judged at their readings, apart
/// from those that are measured at every sample: with the model as it is at a sample time as long.
namespace mpm {

/// An extended model, and the aux signals that it takes as inputs after the given model's.
struct Extended {
  ModelSpec model;
  std::vector<int> new_inputs = {};
};

/// A whole with the channels, disturbances and sensors of a part's CVs as that has them. What an
/// actuator does beyond the given model is put before the part's channels alone: the other CVs were
/// judged, and scored, without it. `inputs`: of the given model.
[[nodiscard]] Extended within(Extended whole, const Extended& part, const std::vector<int>& cvs,
                              int inputs);

/// The recordings that were diagnosed; `validation` may be null.
struct Recorded {
  const Recording& recording;
  const Recording* validation;
};

/// Of a model in channels with no CV judged: all are simulated and scored, on what comes after the
/// first `fitted` rows or on the second recording.
[[nodiscard]] Diagnosis unjudged(const ModelSpec& model, const Recorded& data, Eigen::Index fitted);

/// Takes the diagnosis of a part into that of the whole, in the numbers of the whole.
void take_in(const ModelSpec& model, const Recorded& data, const Readings& readings, Diagnosis part,
             Diagnosis& whole);

}  // namespace mpm
