#include "core/identify/diagnosis/compressed.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"

namespace mpm {

Compressed::Compressed(const Recording& recording) {
  for (Eigen::Index cv = 0; cv < recording.cvs.cols(); ++cv)
    traits_.push_back(historian_traits(recording.cvs.col(cv)));
}

bool Compressed::any() const {
  return std::any_of(traits_.begin(), traits_.end(),
                     [](const HistorianTraits& traits) { return traits.compressed(); });
}

bool Compressed::may_have_made(const Finding& finding) const {
  const Subject& subject = finding.subject;
  if (subject.place.cv < 0 || !cv(subject.place.cv)) return false;
  const HistorianTraits& traits = traits_[static_cast<std::size_t>(subject.place.cv)];
  if (beyond_use(traits)) return true;
  if (subject.cause->acts_through_channels()) return false;
  const Parameter* size = finding.find(kSize);
  if (size == nullptr) return true;
  return std::abs(size->value) <=
         (traits.deadband > 0.0 ? kDeadbandsThatTell * traits.deadband : traits.sd);
}

}  // namespace mpm
