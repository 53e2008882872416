#include "tests/hidden/score.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <sstream>

#include "tests/hidden/answer.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string column_of(const Diagnosis& diagnosis) {
  if (!diagnosis.findings.empty()) return diagnosis.findings.front().subject.cause->name().text;
  if (diagnosis.verdict == DiagnosisVerdict::kMatch) return "none";
  return diagnosis.verdict == DiagnosisVerdict::kMismatch ? "unnamed" : "undetermined";
}

bool is_confident(const Finding& finding) { return finding.confidence >= kConfident; }

/// What a parameter is where plant and model agree.
double without_effect(const std::string& name) {
  const bool ratio = name.size() > 6 && name.compare(name.size() - 6, 6, "_ratio") == 0;
  return ratio ? 1.0 : 0.0;
}

/// A periodic disturbance of the other sign is the same half a period later.
bool has_free_sign(const TrueEffect& truth, const std::string& name) {
  return truth.cause == &causes::periodic_disturbance() && name == "size";
}

void score_parameters(const TrueEffect& truth, const Finding& finding, CaseScore& result) {
  for (const Parameter& stated : finding.parameters) {
    const auto place = truth.parameters.find(stated.name());
    if (place == truth.parameters.end()) continue;
    const double value = place->second;
    const auto miss = [&](double wanted) { return std::abs(stated.value - wanted); };
    const auto covers = [&](double wanted) {
      return stated.low <= wanted && wanted <= stated.high;
    };
    const bool either = has_free_sign(truth, stated.name());
    result.parameters.push_back({stated.name(), covers(value) || (either && covers(-value)),
                                 (either ? std::min(miss(value), miss(-value)) : miss(value)) /
                                     std::abs(value - without_effect(stated.name()))});
  }
}

void score_place(const HiddenCase& hidden, const TrueEffect& truth, const Answer& answer,
                 CaseScore& result) {
  result.place_right = result.place_right.value_or(true) && answer.match == Match::kPlace;
  result.has_onset = result.has_onset || truth.onset_s.has_value();
  if (answer.match != Match::kPlace) return;
  const Finding& first = *answer.findings.front();
  if (*truth.cause->kind() != '\0')
    result.kind_right = result.kind_right.value_or(true) && truth.cause == first.subject.cause;
  for (const Finding* finding : answer.findings) score_parameters(truth, *finding, result);
  if (truth.onset_s && first.onset_s)
    result.onset_error =
        std::max(result.onset_error.value_or(0.0),
                 std::abs(*first.onset_s - *truth.onset_s) / hidden.data.sample_time_s);
}

void score_named(const HiddenCase& hidden, const Diagnosis& diagnosis, CaseScore& result) {
  std::vector<Answer> answers;
  std::vector<const Finding*> used;
  for (const TrueEffect& truth : hidden.truth) {
    answers.push_back(answer_to(hidden, truth, diagnosis.findings));
    used.insert(used.end(), answers.back().findings.begin(), answers.back().findings.end());
  }
  const bool all = std::all_of(answers.begin(), answers.end(),
                               [](const Answer& answer) { return answer.match != Match::kOther; });
  const auto is_used = [&](const Finding& finding) {
    return std::find(used.begin(), used.end(), &finding) != used.end();
  };
  // The first finding must be one of the cause even if another says the place better.
  const bool first =
      !diagnosis.findings.empty() &&
      (is_used(diagnosis.findings.front()) ||
       match(hidden, hidden.truth.front(), diagnosis.findings.front().subject) != Match::kOther);
  result.cause_right = all && (first || hidden.truth.size() > 1);
  result.extra =
      static_cast<int>(std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                                     [&](const Finding& finding) { return !is_used(finding); }));
  if (!result.cause_right) return;
  for (std::size_t i = 0; i < answers.size(); ++i)
    score_place(hidden, hidden.truth[i], answers[i], result);
}

void score_unnamed(const HiddenCase& hidden, const Diagnosis& diagnosis, CaseScore& result) {
  const int cv = hidden.truth.front().place.cv;
  result.extra = static_cast<int>(
      std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(), is_confident));
  result.cause_right = diagnosis.verdict == DiagnosisVerdict::kMismatch && result.extra == 0;
  if (!result.cause_right) return;
  result.place_right =
      std::any_of(diagnosis.unexplained.begin(), diagnosis.unexplained.end(),
                  [&](const Unexplained& rest) { return rest.subject.place.cv == cv; }) ||
      std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                  [&](const Finding& finding) { return finding.subject.place.cv == cv; });
}

/// Whether something was hidden in this CV, or nothing anywhere.
bool is_affected(const HiddenCase& hidden, Index cv) {
  const auto acts = [&](const TrueEffect& truth) {
    if (truth.place.cv >= 0) return truth.place.cv == cv;
    return std::any_of(
        hidden.model.channels.begin(), hidden.model.channels.end(),
        [&](const ChannelSpec& c) { return c.cv == cv && c.input == truth.place.input; });
  };
  return hidden.truth.empty() || std::any_of(hidden.truth.begin(), hidden.truth.end(), acts);
}

void score_rmse(const HiddenCase& hidden, const Diagnosis& diagnosis, CaseScore& result) {
  result.rmse_before = result.rmse_after = kNaN;
  if (static_cast<Index>(diagnosis.scores.size()) != hidden.data.cvs.cols()) return;
  const Index from = diagnosis.fit_samples > 0 ? diagnosis.fit_samples : hidden.fit_samples();
  const Index count = hidden.data.samples() - from;
  double before = 0.0;
  double after = 0.0;
  double cvs = 0.0;
  for (Index cv = 0; cv < hidden.data.cvs.cols(); ++cv) {
    if (!is_affected(hidden, cv)) continue;
    ++cvs;
    const double best =
        std::sqrt((hidden.data.cvs.col(cv) - hidden.noise_free.col(cv)).tail(count).squaredNorm() /
                  static_cast<double>(count));
    const CvScore& score = diagnosis.scores[static_cast<std::size_t>(cv)];
    before += std::pow(score.rmse_before / best, 2);
    after += std::pow(score.rmse_after / best, 2);
  }
  result.rmse_before = std::sqrt(before / cvs);
  result.rmse_after = std::sqrt(after / cvs);
}

void print_place(std::ostream& out, const Place& place) {
  if (place.cv >= 0) out << " y" << place.cv + 1;
  if (place.input >= 0) out << " u" << place.input + 1;
  if (place.aux >= 0) out << " aux" << place.aux + 1;
}

void print_kind(std::ostream& out, const std::string& kind) {
  if (!kind.empty()) out << ' ' << kind;
}

void print_onset(std::ostream& out, const std::optional<double>& onset_s) {
  if (onset_s) out << " from " << std::llround(*onset_s) << " s";
}

std::string describe(const Diagnosis& diagnosis) {
  std::ostringstream out;
  out.precision(3);
  for (const Finding& finding : diagnosis.findings) {
    const Subject& subject = finding.subject;
    if (&finding != &diagnosis.findings.front()) out << " + ";
    out << subject.cause->name().text;
    print_place(out, subject.place);
    print_kind(out, subject.cause->kind());
    for (const Parameter& parameter : finding.parameters)
      out << ' ' << parameter.name() << '=' << parameter.value << " [" << parameter.low << ", "
          << parameter.high << ']';
    print_onset(out, finding.onset_s);
    out << " (" << finding.confidence << ')';
  }
  if (diagnosis.findings.empty()) out << column_of(diagnosis);
  for (const Unexplained& rest : diagnosis.unexplained) {
    out << " + unexplained";
    print_place(out, rest.subject.place);
  }
  for (const Finding& finding : diagnosis.refused) {
    out << " - refused " << finding.subject.cause->name().text;
    print_place(out, finding.subject.place);
  }
  return out.str();
}

}  // namespace

std::string describe(const HiddenCase& hidden) {
  std::ostringstream out;
  out.precision(3);
  for (std::size_t i = 0; i < hidden.truth.size(); ++i) {
    const TrueEffect& effect = hidden.truth[i];
    if (i > 0) out << " + ";
    out << (effect.cause ? effect.cause->name().text : "unnamed");
    print_place(out, effect.place);
    print_kind(out, effect.cause ? effect.cause->kind() : effect.manner);
    for (const auto& [name, value] : effect.parameters) out << ' ' << name << '=' << value;
    print_onset(out, effect.onset_s);
    if (effect.cause != &causes::noise())
      out << " (evidence " << std::llround(hidden.evidence[i]) << ')';
  }
  return hidden.truth.empty() ? "none" : out.str();
}

CaseScore score(const HiddenCase& hidden, const Diagnosis& diagnosis, double seconds) {
  CaseScore result;
  result.request = hidden.request;
  result.named = column_of(diagnosis);
  result.seconds = seconds;
  if (hidden.truth.empty()) {
    result.extra = static_cast<int>(diagnosis.findings.size());
    result.cause_right = result.extra == 0 && diagnosis.verdict == DiagnosisVerdict::kMatch;
  } else if (!hidden.truth.front().cause) {
    score_unnamed(hidden, diagnosis, result);
  } else {
    score_named(hidden, diagnosis, result);
  }
  score_rmse(hidden, diagnosis, result);
  result.truth = describe(hidden);
  result.answer = describe(diagnosis);
  return result;
}

CaseScore score_one(const CaseRequest& request) {
  const HiddenCase hidden = draw_case(request);
  DiagnosisSettings settings;
  settings.mv_count = hidden.mv_count;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  std::optional<Diagnosis> diagnosis;
  std::string failure;
  try {
    diagnosis = diagnose(hidden.model, hidden.data, nullptr, settings);
  } catch (const std::exception& error) {  // it never should; the other cases still count
    diagnosis.emplace();
    failure = error.what();
  }
  CaseScore result =
      score(hidden, *diagnosis, std::chrono::duration<double>(Clock::now() - begin).count());
  if (!failure.empty()) {
    result.named = kFailed;
    result.answer = "FAILED: " + failure;
  }
  return result;
}

}  // namespace mpm::hidden
