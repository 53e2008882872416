#include "core/identify/evidence/change_row.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "core/identify/evidence/calibration.hpp"
#include "core/identify/evidence/regress_recording.hpp"
#include "core/mismatch/change_scan.hpp"

namespace mpm {

using Eigen::Index;

namespace {

std::vector<int> rejected_cvs(const ModelSpec& model, const ChannelTests& tests) {
  std::vector<int> cvs;
  for (int cv = 0; cv < model.cv_count; ++cv)
    if (tests.reject(tests.channels_to(cv))) cvs.push_back(cv);
  return cvs;
}

}  // namespace

std::optional<Index> change_row(const ModelSpec& model, const Recording& recording,
                                const Eigen::MatrixXd& residuals, const ChannelTests& tests) {
  const Index samples = recording.samples();
  if (!recording.borders.empty() || samples > kMostRemembered) return std::nullopt;
  const std::vector<int> cvs = rejected_cvs(model, tests);
  if (cvs.empty()) return std::nullopt;
  const std::unique_ptr<MismatchDetector> detector =
      regress_recording(model, recording, residuals, samples).detector;
  if (!detector) return std::nullopt;
  ChangeScan scan(detector->shape());
  std::optional<Index> row;
  double gain = 0.0;
  for (const int cv : cvs) {
    detector->fold(cv);
    const std::optional<ChangePoint> change = scan.scan(*detector, cv);
    if (!change || change->kind == ChangeKind::kEnded || !(change->gain > gain)) continue;
    gain = change->gain;
    row = samples - change->samples;
  }
  return row;
}

}  // namespace mpm
