#include "daemon/live/named_cause.hpp"

#include <algorithm>

#include "core/identify/causes/cause.hpp"
#include "daemon/report/diagnosis/explain.hpp"

namespace mpm::live {
namespace {

bool touches(const Place& place, int input, int cv) {
  return (place.cv < 0 || place.cv == cv) && (place.input < 0 || place.input == input);
}

report::NamedCause cause_of(const report::DiagnosisRun& run, int input, int cv) {
  const std::vector<Finding>& findings = run.diagnosis.findings;
  report::NamedCause named;
  const auto own = std::find_if(findings.begin(), findings.end(), [=](const Finding& finding) {
    return touches(finding.subject.place, input, cv);
  });
  if (own != findings.end()) {
    named.cause = own->subject.cause->name().text;
    named.text = report::explain(run, *own);
    named.confidence = own->confidence;
    for (const Parameter& parameter : own->parameters)
      named.parameters.push_back(
          {parameter.name(), parameter.value, parameter.low, parameter.high});
    return named;
  }
  const auto on_cv = std::find_if(findings.begin(), findings.end(), [=](const Finding& finding) {
    return finding.subject.place.cv == cv;
  });
  named.text = on_cv == findings.end()
                   ? report::verdict_sentence(run)
                   : "Not this channel, but another of its CV: " + report::explain(run, *on_cv);
  return named;
}

}  // namespace

std::vector<report::NamedCause> causes_of_channels(const report::DiagnosisRun& run) {
  const SignalCounts counts = run.unit.counts();
  std::vector<report::NamedCause> causes;
  for (int input = 0; input < counts.inputs(); ++input)
    for (int cv = 0; cv < counts.cv; ++cv) causes.push_back(cause_of(run, input, cv));
  return causes;
}

}  // namespace mpm::live
