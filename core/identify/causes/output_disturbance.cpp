#include "core/identify/causes/output_disturbance.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

bool OutputDisturbance::goes_with(const Effect&, const Effect&) const { return true; }

std::string OutputDisturbance::sentence(const Finding& finding, const SignalNames& names) const {
  const SignalName& cv = names.cv(finding.subject.place.cv);
  const Parameter* size = finding.find(kSize);
  std::string text =
      cv.tag + " " + what_it_does(finding, names) + ", which its inputs do not explain";
  if (size != nullptr) text += " (size " + interval_of(*size, cv.unit) + ")";
  return text + ". A disturbance or an offset of its sensor: the data cannot tell the two apart. ";
}

std::string OutputDisturbance::up_or_down(const Finding& finding, const SignalNames& names) {
  const Parameter* size = finding.find(kSize);
  return std::string(size != nullptr && size->value < 0.0 ? "down" : "up") +
         by_size(finding, names);
}

std::string OutputDisturbance::by_size(const Finding& finding, const SignalNames& names) {
  const Parameter* size = finding.find(kSize);
  return size == nullptr ? ""
                         : " by " + names.in_cv(std::abs(size->value), finding.subject.place.cv);
}

double OutputDisturbance::left_sd(const CvFit& without) {
  const auto samples = static_cast<double>(without.residual.size());
  return std::max(1e-30, std::sqrt(without.residual.squaredNorm() / samples));
}

double OutputDisturbance::onset_s(const Effect& effect, const Surroundings& surroundings) {
  return surroundings.start_s + static_cast<double>(effect.onset) * surroundings.sample_time_s;
}

namespace causes {

bool is_break(const Effect& effect) {
  return effect.place.input < 0 && effect.place.aux < 0 &&
         !cause_of(effect).acts_through_channels() && !is_constant_offset(effect);
}

std::size_t breaks_of(const std::vector<Effect>& effects, int cv) {
  return static_cast<std::size_t>(std::count_if(
      effects.begin(), effects.end(),
      [&](const Effect& effect) { return effect.place.cv == cv && is_break(effect); }));
}

}  // namespace causes

}  // namespace mpm
