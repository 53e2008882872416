#include "daemon/report/diagnosis/names_of.hpp"

namespace mpm::report {

SignalNames names_of(const DiagnosisRun& run) {
  SignalNames names;
  for (const config::InputSignal& mv : run.unit.mv) names.inputs.push_back({mv.tag, mv.unit});
  for (const config::InputSignal& dv : run.unit.dv) names.inputs.push_back({dv.tag, dv.unit});
  for (const config::InputSignal& aux : run.unit.aux) names.aux.push_back({aux.tag, aux.unit});
  for (const config::CvSignal& cv : run.unit.cv) names.aux.push_back({cv.setpoint, cv.unit});
  for (const int aux : run.diagnosis.new_inputs)
    names.inputs.push_back(names.aux.at(static_cast<std::size_t>(aux)));
  for (const config::CvSignal& cv : run.unit.cv) names.cvs.push_back({cv.tag, cv.unit});
  names.model = run.unit.model;
  return names;
}

const char* other_text(const Finding& finding) {
  return *finding.with == finding.subject ? "the other " : "";
}

std::string needed_text(const SignalNames& names, const Finding& finding) {
  return other_text(finding) + names.subject(*finding.with);
}

}  // namespace mpm::report
