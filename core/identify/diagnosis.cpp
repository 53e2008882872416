#include "core/identify/diagnosis.hpp"

namespace mpm {

Eigen::Index needed_samples(const ModelSpec&) { return 200; }

Diagnosis diagnose(const ModelSpec& model, const Recording& recording, const Recording* validation,
                   const DiagnosisSettings& settings) {
  Diagnosis diagnosis;
  diagnosis.samples = recording.samples();
  diagnosis.extended = model;
  static_cast<void>(validation);
  static_cast<void>(settings);
  return diagnosis;
}

}  // namespace mpm
