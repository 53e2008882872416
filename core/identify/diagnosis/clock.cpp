#include "core/identify/diagnosis/clock.hpp"

#include <cmath>

namespace mpm {

void tell_on_clock(const Recording& recording, const ModelSpec& given, Diagnosis& diagnosis) {
  if (recording.borders.empty()) return;
  for (std::vector<Finding>* findings : {&diagnosis.findings, &diagnosis.refused})
    for (Finding& finding : *findings)
      if (finding.onset_s) finding.onset_s = on_clock(recording, *finding.onset_s);
  std::vector<DisturbanceTerm>& terms = diagnosis.extended.disturbances;
  for (std::size_t i = given.disturbances.size(); i < terms.size(); ++i) {
    DisturbanceTerm& term = terms[i];
    term.onset_s = on_clock(recording, term.onset_s);
    if (std::isfinite(term.until_s)) term.until_s = on_clock(recording, term.until_s);
  }
}

}  // namespace mpm
