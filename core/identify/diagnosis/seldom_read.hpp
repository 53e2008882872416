#pragma once

#include <Eigen/Core>
#include <functional>
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

/// CVs that are read in one cycle as they are judged, at a sample time as long.
struct AtReadings {
  const ModelSpec& model;
  double every;  ///< samples
  const Recording& recording;
  const Recording* validation;  ///< may be null
};

/// The diagnosis of a model (of such CVs, at its own sample time) at their readings.
using Judge =
    std::function<Diagnosis(const ModelSpec&, const AtReadings&, const DiagnosisSettings&)>;

/// That of a model in channels: one after the other those that are read in the same cycle.
/// `settings.progress` is there.
[[nodiscard]] Diagnosis by_readings(const ModelSpec& model, const Recorded& data,
                                    const std::vector<Readings>& all,
                                    const DiagnosisSettings& settings, const Judge& judge);

}  // namespace mpm
