#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/identification/identification_run.hpp"

/// What is wrong where: CVs by inputs, a column for what is wrong with a CV itself and a row for
/// what is wrong with an input itself.
namespace mpm::report {

/// {inputs, rows: [{tag, cells: [{state, text, findings: [{number, text}]}]}]}; no text where the
/// state says it all. `state`:
///   wrong   a finding that the extended model repairs
///   doubt   a finding that it does not hold, or data that do not tell
///   right   the data agree with the model
///   none    no channel
[[nodiscard]] nlohmann::ordered_json matrix_json(const DiagnosisRun& run);
/// The same of an identification: `right` = identified.
[[nodiscard]] nlohmann::ordered_json matrix_json(const IdentificationRun& run);

/// A finding in a few words, without its place: "gain × 1.41, dead time +14 s", "step +1.3 K".
[[nodiscard]] std::string short_text(const DiagnosisRun& run, const Finding& finding);
/// Where it is: "u3 → y3", "y1".
[[nodiscard]] std::string place_text(const DiagnosisRun& run, const Subject& subject);
/// What a cause is called inside a sentence: "gain", "sticking valve".
[[nodiscard]] std::string cause_text(const Subject& subject);
/// A parameter's value as the page says it, and its interval; the latter may be empty.
struct ParameterText {
  std::string name, value, interval;
};
[[nodiscard]] ParameterText parameter_text(const DiagnosisRun& run, const Finding& finding,
                                           const Parameter& parameter);

}  // namespace mpm::report
