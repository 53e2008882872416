#include "daemon/report/diagnosis/explain.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "core/model/linear_model.hpp"
#include "daemon/report/diagnosis/number_text.hpp"
#include "daemon/report/diagnosis/signal_names.hpp"

namespace mpm::report {
namespace {

const Parameter* find(const Finding& finding, std::string_view name) {
  const auto found =
      std::find_if(finding.parameters.begin(), finding.parameters.end(),
                   [name](const Parameter& parameter) { return parameter.name == name; });
  return found == finding.parameters.end() ? nullptr : &*found;
}

double value_of(const Finding& finding, std::string_view name, double otherwise) {
  const Parameter* parameter = find(finding, name);
  return parameter == nullptr ? otherwise : parameter->value;
}

std::string interval(const Parameter& parameter, const std::string& unit = {}) {
  return "95 % interval " + interval_text(parameter.low, parameter.high) +
         (unit.empty() ? "" : " " + unit);
}

std::string percent(double share) { return number_text(100.0 * share, 2) + " %"; }

/// "25 % less", "30 % more", "in the opposite direction"
std::string compare(double ratio) {
  if (ratio < 0.0) return "in the opposite direction and " + number_text(-ratio) + " times as much";
  return percent(std::abs(ratio - 1.0)) + (ratio < 1.0 ? " less" : " more");
}

/// The model's gain and the plant's, where the channel settles: "gain 3.04 instead of 4.05".
std::string gains(const DiagnosisRun& run, const Subject& subject, double ratio) {
  if (subject.cv < 0 || subject.input < 0 || subject.input >= run.unit.model.input_count) return {};
  const LinearModel model(run.unit.model);
  const double gain = model.steady_gain()(subject.cv, subject.input);
  if (gain == 0.0 || model.integrating()(subject.cv, subject.input)) return {};
  const SignalNames names(run.unit, run.diagnosis);
  const std::string& over = names.source_unit(subject);
  return "gain " + number_text(ratio * gain) + " instead of " + number_text(gain) +
         (over.empty() ? "" : " " + names.cv_unit(subject.cv) + " per " + over) + "; ";
}

// One function per group of causes; each gives whole sentences.

std::string gain_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Subject& subject = finding.subject;
  const Parameter* ratio = find(finding, "gain_ratio");
  if (ratio == nullptr) return {};
  return names.cv(subject.cv) + " answers " + names.source(subject) + " " + compare(ratio->value) +
         " than the model says (" + gains(run, subject, ratio->value) + interval(*ratio) +
         " of the ratio). ";
}

std::string dead_time_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Parameter* error = find(finding, "dead_time_error");
  if (error == nullptr) return {};
  const bool late = error->value >= 0.0;
  return names.cv(finding.subject.cv) + " answers " + names.source(finding.subject) + " " +
         number_text(std::abs(error->value)) + " s " + (late ? "later" : "sooner") +
         " than the model says (dead time error " + interval(*error, "s") + "). ";
}

std::string time_constant_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Parameter* ratio = find(finding, "time_constant_ratio");
  if (ratio == nullptr) return {};
  const bool slow = ratio->value >= 1.0;
  return "The answer of " + names.cv(finding.subject.cv) + " to " + names.source(finding.subject) +
         " is " + number_text(slow ? ratio->value : 1.0 / ratio->value) + " times " +
         (slow ? "slower" : "faster") + " than the model's (time constant ratio " +
         interval(*ratio) + "). ";
}

std::string input_scale_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const std::string source = names.source(finding.subject);
  const Parameter* ratio = find(finding, "gain_ratio");
  std::string text = "Every CV answers " + source;
  if (ratio != nullptr) text += " " + compare(ratio->value);
  text += " than the model says";
  if (ratio != nullptr) text += " (" + interval(*ratio) + " of the ratio)";
  return text + ". That points to the actuator or the flow meter of " + source +
         ", not to one channel. ";
}

std::string output_scale_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const std::string& cv = names.cv(finding.subject.cv);
  const Parameter* ratio = find(finding, "gain_ratio");
  std::string text = cv + " moves";
  if (ratio != nullptr) text += " " + compare(ratio->value);
  text += " than the model says, whatever input moves it";
  if (ratio != nullptr) text += " (" + interval(*ratio) + " of the ratio)";
  return text + ". That points to the span of its sensor. ";
}

std::string input_nonlinearity_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Subject& subject = finding.subject;
  const std::string source = names.source(subject);
  const std::string target = subject.cv >= 0 ? names.cv(subject.cv) : "the plant";
  if (subject.kind == "saturation") {
    const Parameter* low = find(finding, "low");
    const Parameter* high = find(finding, "high");
    const auto limit = [&](const Parameter& at) {
      return names.in_source(at.value, subject) + " (" + interval(at) + ")";
    };
    std::string text = source + " acts on " + target + " only";
    if (low != nullptr) text += " above " + limit(*low);
    if (low != nullptr && high != nullptr) text += " and";
    if (high != nullptr) text += " below " + limit(*high);
    return text + "; what it asks for beyond has no effect. ";
  }
  if (subject.kind == "deadband") {
    const Parameter* width = find(finding, "width");
    if (width == nullptr && !finding.parameters.empty()) width = &finding.parameters.front();
    return source + " has play: after it turns, it must move " +
           (width == nullptr ? "some way" : names.in_source(width->value, subject)) + " before " +
           target + " follows" + (width == nullptr ? "" : " (" + interval(*width) + ")") + ". ";
  }
  return target + " does not answer " + source +
         " in proportion: the answer to a large move is not a small one's, enlarged. ";
}

std::string stiction_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Subject& subject = finding.subject;
  std::string text = "The valve of " + names.source(subject) + " sticks";
  if (const Parameter* band = find(finding, "band"))
    text += ": it rests until its command has moved " + names.in_source(band->value, subject) +
            " (" + interval(*band) + ")";
  if (const Parameter* jump = find(finding, "jump"))
    text +=
        ", then jumps by " + names.in_source(jump->value, subject) + " (" + interval(*jump) + ")";
  return text + ". ";
}

std::string output_nonlinearity_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Subject& subject = finding.subject;
  const std::string& cv = names.cv(subject.cv);
  if (subject.kind != "saturation") return cv + " does not follow the model in proportion. ";
  std::string text = cv + " does not read";
  const Parameter* low = find(finding, "low");
  const Parameter* high = find(finding, "high");
  if (low != nullptr && std::isfinite(low->value))
    text += " below " + names.in_cv(low->value, subject.cv);
  if (low != nullptr && high != nullptr && std::isfinite(low->value) && std::isfinite(high->value))
    text += " nor";
  if (high != nullptr && std::isfinite(high->value))
    text += " above " + names.in_cv(high->value, subject.cv);
  return text + ": a clipped sensor or an overflow. ";
}

std::string unmodelled_input_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Subject& subject = finding.subject;
  std::string text = names.cv(subject.cv) + " follows " + names.source(subject) +
                     (subject.aux >= 0 ? ", a signal that the model leaves out"
                                       : ", to which the model does not connect it");
  if (const Parameter* gain = find(finding, "gain")) {
    const std::string per = parameter_unit(run, subject, "gain");
    text += ": gain " + number_text(gain->value) + (per.empty() ? "" : " " + per) + " (" +
            interval(*gain) + ")";
  }
  if (const Parameter* lag = find(finding, "time_constant"))
    text += ", time constant " + number_text(lag->value) + " s";
  if (const Parameter* delay = find(finding, "dead_time"))
    text += ", dead time " + number_text(delay->value) + " s";
  return text + ". ";
}

std::string output_disturbance_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const int cv = finding.subject.cv;
  const std::string& kind = finding.subject.kind;
  const Parameter* size = find(finding, "size");
  const bool down = size != nullptr && size->value < 0.0;
  const std::string by = size == nullptr ? "" : " by " + names.in_cv(std::abs(size->value), cv);
  std::string text = names.cv(cv);
  if (kind == "drift") {
    text += std::string(" drifts ") + (down ? "down" : "up") + by +
            " until the end of the data that were fitted";
  } else if (kind == "periodic") {
    text += " swings" + by + " up and down";
    if (const Parameter* period = find(finding, "period"))
      text += " every " + number_text(period->value) + " s";
  } else {
    text += std::string(" is shifted ") + (down ? "down" : "up") + by;
  }
  text += ", which its inputs do not explain";
  if (size != nullptr) text += " (size " + interval(*size, names.cv_unit(cv)) + ")";
  return text + ". A disturbance or an offset of its sensor: the data cannot tell the two apart. ";
}

std::string noise_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const Parameter* ratio = find(finding, "variance_ratio");
  std::string text = "The noise on " + names.cv(finding.subject.cv) + " changed";
  if (ratio != nullptr)
    text += ": its variance is " + number_text(ratio->value) + " times what it was (" +
            interval(*ratio) + ")";
  return text + ". No repair of the model removes that. ";
}

std::string state_nonlinearity_sentence(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names(run.unit, run.diagnosis);
  const std::string& cv = names.cv(finding.subject.cv);
  const std::string& kind = finding.subject.kind;
  if (kind == "square_root_outflow")
    return cv +
           " drains with the square root of its level, where the model drains in proportion: "
           "its gain and its time constants depend on the level. ";
  if (kind == "coulomb_friction")
    return "Dry friction holds " + cv + " back" +
           (find(finding, "force") == nullptr
                ? ""
                : ": " + names.in_source(value_of(finding, "force", 0.0), finding.subject) +
                      " of its input") +
           ". ";
  return cv + " is pushed back by a force that does not grow in proportion to it" +
         (kind.empty() ? "" : " (" + kind + ")") + ". ";
}

std::string cause_sentence(const DiagnosisRun& run, const Finding& finding) {
  switch (finding.subject.cause) {
    case Cause::kGain:
      return gain_sentence(run, finding);
    case Cause::kDeadTime:
      return dead_time_sentence(run, finding);
    case Cause::kTimeConstant:
      return time_constant_sentence(run, finding);
    case Cause::kDynamics:
      return gain_sentence(run, finding) + time_constant_sentence(run, finding) +
             dead_time_sentence(run, finding);
    case Cause::kInputScale:
      return input_scale_sentence(run, finding);
    case Cause::kOutputScale:
      return output_scale_sentence(run, finding);
    case Cause::kInputNonlinearity:
      return input_nonlinearity_sentence(run, finding);
    case Cause::kStiction:
      return stiction_sentence(run, finding);
    case Cause::kOutputNonlinearity:
      return output_nonlinearity_sentence(run, finding);
    case Cause::kUnmodelledInput:
      return unmodelled_input_sentence(run, finding);
    case Cause::kOutputDisturbance:
      return output_disturbance_sentence(run, finding);
    case Cause::kNoise:
      return noise_sentence(run, finding);
    case Cause::kStateNonlinearity:
      return state_nonlinearity_sentence(run, finding);
    case Cause::kUnnamed:
      break;
  }
  return {};
}

/// The CV that gained most: "On samples that no fit has seen, ...".
std::string gain_of_extension(const DiagnosisRun& run) {
  const SignalNames names(run.unit, run.diagnosis);
  const CvScore* best = nullptr;
  int best_cv = 0;
  for (std::size_t cv = 0; cv < run.diagnosis.scores.size(); ++cv) {
    const CvScore& score = run.diagnosis.scores[cv];
    if (score.gain_low <= 0.0 || score.refused) continue;
    if (best != nullptr && score.gain_low <= best->gain_low) continue;
    best = &score;
    best_cv = static_cast<int>(cv);
  }
  if (best == nullptr) return {};
  return "On samples that the fit has not seen, the extended model's error of " +
         names.cv(best_cv) + " is " + names.in_cv(best->rmse_after, best_cv) + " instead of " +
         names.in_cv(best->rmse_before, best_cv) + " RMS.";
}

}  // namespace

const char* name_of(DiagnosisVerdict verdict) {
  switch (verdict) {
    case DiagnosisVerdict::kMatch:
      return "match";
    case DiagnosisVerdict::kMismatch:
      return "mismatch";
    case DiagnosisVerdict::kUndetermined:
      return "undetermined";
  }
  return "";
}

std::string verdict_headline(const DiagnosisRun& run) {
  const std::string& unit = run.unit.unit;
  switch (run.diagnosis.verdict) {
    case DiagnosisVerdict::kMatch:
      return "The model of " + unit +
             " matches the plant: these data show no difference that matters.";
    case DiagnosisVerdict::kUndetermined:
      return "These data do not tell whether the model of " + unit + " matches the plant.";
    case DiagnosisVerdict::kMismatch:
      break;
  }
  const std::size_t count = run.diagnosis.findings.size();
  std::string text = "The model of " + unit + " does not match the plant: ";
  if (count == 0) text += "a difference is there, but none of the known causes explains it.";
  if (count == 1) text += "one cause was found.";
  if (count > 1) text += std::to_string(count) + " causes were found.";
  return text;
}

std::string verdict_details(const DiagnosisRun& run) {
  std::string text = run.diagnosis.reason;
  if (!text.empty()) {
    const std::string word = text.substr(0, text.find(' '));
    const bool is_word = std::all_of(word.begin(), word.end(), [](unsigned char letter) {
      return std::islower(letter) != 0;  // not a tag, whose case matters
    });
    if (is_word) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (text.back() != '.') text += '.';
  }
  const std::string gain = gain_of_extension(run);
  return gain + (gain.empty() || text.empty() ? "" : " ") + text;
}

std::string verdict_sentence(const DiagnosisRun& run) {
  const std::string details = verdict_details(run);
  return verdict_headline(run) + (details.empty() ? "" : " ") + details;
}

std::string explain(const DiagnosisRun& run, const Finding& finding) {
  std::string text = cause_sentence(run, finding);
  if (text.empty())
    text = "The plant differs from the model: " +
           SignalNames(run.unit, run.diagnosis).subject(finding.subject) + ". ";
  if (finding.onset_s) text += "It began at " + clock_text(*finding.onset_s) + ". ";
  text.pop_back();
  if (text.rfind("the plant", 0) == 0) text[0] = 'T';
  return text;
}

std::string rival_text(const DiagnosisRun& run, const Rival& rival) {
  const std::string name = SignalNames(run.unit, run.diagnosis).subject(rival.subject);
  if (rival.inseparable) return name + ": the data do not decide between the two";
  constexpr double kBeyondWords = 40.0;  // odds of 1 to 5e8
  std::string text = name + ": " + number_text(rival.worse) + " worse (odds 1 to ";
  text += rival.worse > kBeyondWords ? "more than 10^8" : number_text(std::exp(rival.worse / 2), 2);
  return text + ")";
}

std::string unexplained_text(const DiagnosisRun& run, const Unexplained& left) {
  const SignalNames names(run.unit, run.diagnosis);
  std::string text = percent(left.share) + " of the residual's variance of " + names.cv(left.cv) +
                     " has no named cause";
  if (left.input >= 0) text += "; it goes with " + names.input(left.input);
  if (left.manner == "product") text += ", whose effect seems to change with another input";
  if (left.manner == "swing") text += ", whose effect seems to swing with time";
  if (left.manner == "direction") text += ", whose effect seems slower one way than the other";
  return text + " (p " + number_text(left.p_value, 2) + ")";
}

std::string parameter_unit(const DiagnosisRun& run, const Subject& subject,
                           const std::string& parameter) {
  const SignalNames names(run.unit, run.diagnosis);
  const auto ends_with = [&](std::string_view end) {
    return parameter.size() >= end.size() &&
           parameter.compare(parameter.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_with("ratio")) return "x model";
  if (ends_with("dead_time") || ends_with("dead_time_error") || ends_with("time_constant") ||
      parameter == "period" || parameter == "onset" || parameter == "until")
    return "s";
  if (parameter == "gain" && subject.cv >= 0 && !names.source_unit(subject).empty())
    return names.cv_unit(subject.cv) + " per " + names.source_unit(subject);
  if (parameter == "size" && subject.cv >= 0) return names.cv_unit(subject.cv);
  if (parameter == "rate" && subject.cv >= 0) return names.cv_unit(subject.cv) + "/s";
  if (parameter == "empty_output") return subject.cv >= 0 ? names.cv_unit(subject.cv) : "";
  if (subject.cause == Cause::kOutputNonlinearity)
    return subject.cv >= 0 ? names.cv_unit(subject.cv) : "";
  if (parameter == "band" || parameter == "jump" || parameter == "width" || parameter == "low" ||
      parameter == "high" || parameter == "force" || parameter == "empty_input")
    return names.source_unit(subject);
  return {};
}

}  // namespace mpm::report
