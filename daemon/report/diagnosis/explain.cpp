#include "daemon/report/diagnosis/explain.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/cause.hpp"
#include "core/identify/diagnosis/channel_estimates.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/diagnosis/clock_text.hpp"
#include "daemon/report/diagnosis/names_of.hpp"

namespace mpm::report {
namespace {

/// Share of a free run's squared error from which on a level is most of it. Chosen.
constexpr double kMostlyLevel = 0.5;

/// The CV that gained most: "On samples that no fit has seen, ...".
std::string gain_of_extension(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
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
         names.cv(best_cv).tag + " is " + names.in_cv(best->rmse_after, best_cv) + " instead of " +
         names.in_cv(best->rmse_before, best_cv) + " RMS.";
}

std::string channels_text(const DiagnosisRun& run, const std::vector<Place>& places) {
  const SignalNames names = names_of(run);
  std::string channels;
  for (const Place& place : places)
    channels += (channels.empty() ? "" : ", ") + names.input(place.input).tag + " -> " +
                names.cv(place.cv).tag;
  return channels;
}

/// What the tests reject and no finding is about.
std::string rejected_text(const DiagnosisRun& run) {
  const std::vector<Place>&rejected = run.diagnosis.rejected, &bent = run.diagnosis.bent;
  std::string text;
  if (!rejected.empty())
    text = "The calibrated test rejects " + channels_text(run, rejected) +
           ", of which no cause could be named.";
  if (!bent.empty())
    text +=
        (text.empty() ? "" : " ") +
        ("The nonlinear test finds that " + channels_text(run, bent) +
         (bent.size() == 1 ? " is" : " are") + " not linear, of which no cause could be named.");
  return text;
}

bool is_mostly(double level, double rmse) { return level * level > kMostlyLevel * rmse * rmse; }

/// By how much the extended model has the CV at another level than the unit file's, beside all that
/// is in it as a finding.
double taken_over(const DiagnosisRun& run, int cv) {
  const Eigen::VectorXd& before = run.unit.model.output_origin;
  const Eigen::VectorXd& after = run.diagnosis.extended.output_origin;
  return cv < before.size() && cv < after.size() ? after(cv) - before(cv) : 0.0;
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

std::string difference_headline(const DiagnosisRun& run) {
  const auto from_outside = [](const Finding& finding) {
    return causes::is_from_outside(finding.subject);
  };
  const std::vector<Finding>& findings = run.diagnosis.findings;
  const bool disturbed = !findings.empty() && run.diagnosis.unexplained.empty() &&
                         run.diagnosis.rejected.empty() &&
                         std::all_of(findings.begin(), findings.end(), from_outside);
  const std::string model = "model of " + run.unit.unit;
  if (!disturbed) return "The " + model + " does not match the plant: ";
  if (unknown_gains(run.diagnosis.channels) > 0)
    return "These data do not tell whether the " + model +
           " matches the plant, but something that it does not know of disturbs it: ";
  return "The " + model + " holds, but something that it does not know of disturbs the plant: ";
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
  std::string text = difference_headline(run);
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
  std::string details = gain_of_extension(run);
  for (const std::string& more : {rejected_text(run), text})
    if (!more.empty()) details += (details.empty() ? "" : " ") + more;
  return details;
}

std::string verdict_sentence(const DiagnosisRun& run) {
  const std::string details = verdict_details(run);
  return verdict_headline(run) + (details.empty() ? "" : " ") + details;
}

std::string explain(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names = names_of(run);
  std::string text = finding.subject.cause->sentence(finding, names);
  if (text.empty())
    text = "The plant differs from the model: " + names.subject(finding.subject) + ". ";
  if (finding.onset_s) text += "It began at " + clock_text(*finding.onset_s) + ". ";
  text.pop_back();
  if (text.rfind("the plant", 0) == 0) text[0] = 'T';
  return text;
}

std::string rival_text(const DiagnosisRun& run, const Rival& rival) {
  const std::string name = names_of(run).subject(rival.subject);
  if (rival.inseparable) return name + ": the data do not decide between the two";
  constexpr double kBeyondWords = 40.0;  // odds of 1 to 5e8
  std::string text = name + ": " + number_text(rival.worse) + " worse (odds 1 to ";
  text += rival.worse > kBeyondWords ? "more than 10^8" : number_text(std::exp(rival.worse / 2), 2);
  return text + ")";
}

std::string unexplained_text(const DiagnosisRun& run, const Unexplained& left) {
  const SignalNames names = names_of(run);
  const Place& place = left.subject.place;
  std::string text = percent_text(left.share) + " of the residual's variance of " +
                     names.cv(place.cv).tag + " has no named cause";
  if (place.input >= 0) text += "; it goes with " + names.input(place.input).tag;
  Finding unnamed;
  unnamed.subject = left.subject;
  text += left.subject.cause->sentence(unnamed, names);
  return text + " (p " + number_text(left.p_value, 2) + ")";
}

std::vector<std::string> moved_levels(const DiagnosisRun& run) {
  constexpr const char* kWhy =
      " what is not measured has moved its level, or its sensor drifts. A disturbance that wanders "
      "looks the same";
  std::vector<std::string> texts;
  for (std::size_t cv = 0; cv < run.diagnosis.scores.size(); ++cv) {
    const CvScore& score = run.diagnosis.scores[cv];
    const config::CvSignal& signal = run.unit.cv.at(cv);
    const auto amount = [&](double level) {
      return number_text(std::abs(level), 2) + (signal.unit.empty() ? "" : " " + signal.unit);
    };
    const double moved = taken_over(run, static_cast<int>(cv));
    if (score.fit_after < 0.0 && is_mostly(score.level_after, score.rmse_after))
      texts.push_back(signal.tag + " lies " + amount(score.level_after) +
                      (score.level_after > 0.0 ? " above" : " below") +
                      " its simulation on unseen samples, which is more than it moves:" + kWhy);
    else if (score.fit_before < 0.0 && is_mostly(moved, score.rmse_before))
      texts.push_back(
          "The extended model has " + signal.tag + " " + amount(moved) +
          (moved > 0.0 ? " higher" : " lower") +
          " than the unit file's, which is more than it moves, and most of what it gains is that:" +
          kWhy);
  }
  return texts;
}

}  // namespace mpm::report
