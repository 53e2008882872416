#include "daemon/report/page/channel_matrix.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "daemon/report/diagnosis/names_of.hpp"
#include "daemon/report/identification/reasons.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRarely = 0.1;  ///< times per unit of time: less is said per a longer one
constexpr double kWidest = 0.5;  ///< half an interval of a gain, of the gain: beyond, not told

std::string lower(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string signed_text(const std::string& text) {
  return text.rfind("\u2212", 0) == 0 ? text : "+" + text;
}

Json cell(const char* state, const std::string& text) { return {{"state", state}, {"text", text}}; }

/// Per second, minute, hour or day: the shortest in which it is no tiny number.
ParameterText rate_text(const std::string& name, const Parameter& parameter,
                        const std::string& unit) {
  ParameterText text{name, {}, {}};
  for (const auto& [per, seconds] :
       {std::pair("s", 1.0), {"min", 60.0}, {"h", 3600.0}, {"day", 86400.0}}) {
    const double value = parameter.value * seconds;
    if (std::abs(value) < kRarely && seconds < 86400.0) continue;
    text.value = rounded(value, parameter.low * seconds, parameter.high * seconds,
                         (unit.empty() ? "per " : unit + "/") + per);
    text.interval = interval(value, parameter.low * seconds, parameter.high * seconds);
    break;
  }
  return text;
}

/// Input of the matrix that the finding is about: new ones stand behind the model's own.
int column_of(const DiagnosisRun& run, const Finding& finding) {
  const Place& place = finding.subject.place;
  return place.aux < 0 ? place.input : run.unit.counts().inputs() + place.aux;
}

/// All findings of one cell; the state of the gravest.
Json finding_cell(const DiagnosisRun& run, const std::vector<std::size_t>& numbers) {
  Json findings = Json::array();
  bool repaired = false;
  for (const std::size_t number : numbers) {
    const Finding& finding = run.diagnosis.findings[number];
    repaired = repaired || finding.repaired;
    findings.push_back({{"number", number + 1}, {"text", short_text(run, finding)}});
  }
  Json json = cell(repaired ? "wrong" : "doubt", "");
  json["findings"] = findings;
  return json;
}

/// What the data say of a channel that no finding names.
Json estimate_cell(const DiagnosisRun& run, int cv, int input) {
  const std::vector<ChannelEstimate>& channels = run.diagnosis.channels;
  const auto known = std::find_if(
      channels.begin(), channels.end(),
      [&](const ChannelEstimate& each) { return each.cv == cv && each.input == input; });
  if (known == channels.end()) return cell("none", "");
  const std::vector<Place>& rejected = run.diagnosis.rejected;
  if (std::any_of(rejected.begin(), rejected.end(),
                  [&](const Place& place) { return place.cv == cv && place.input == input; }))
    return cell("doubt", "");
  const Parameter& gain = known->gain_ratio;
  if (run.diagnosis.verdict == DiagnosisVerdict::kUndetermined ||
      !(gain.high - gain.low <= 2.0 * kWidest))
    return cell("doubt", "");
  return cell("right", "");
}

}  // namespace

ParameterText parameter_text(const DiagnosisRun& run, const Finding& finding,
                             const Parameter& parameter) {
  const SignalNames names = names_of(run);
  const Unit unit = parameter.quantity->unit;
  const double value = parameter.value, low = parameter.low, high = parameter.high;
  const std::string name = spaced(parameter.name());
  if (unit == Unit::kSeconds) {
    const bool error = parameter.quantity == &kDeadTimeError;
    const std::string text = duration(value, low, high);
    return {error ? "dead time" : name, error ? signed_text(text) : text,
            duration_interval(value, error ? low : std::max(0.0, low), high)};
  }
  if (unit == Unit::kOfModel) {
    const std::string of = name.substr(0, name.rfind(" ratio"));
    return {of, "\u00d7 " + rounded(value, low, high), interval(value, low, high)};
  }
  if (unit == Unit::kCvPerSecond)
    return rate_text(name, parameter, names.unit_text(Unit::kCv, finding.subject.place));
  return {name, rounded(value, low, high, names.unit_text(unit, finding.subject.place)),
          interval(value, low, high)};
}

std::string place_text(const DiagnosisRun& run, const Subject& subject) {
  const SignalNames names = names_of(run);
  const Place& place = subject.place;
  const std::string& from = names.source(place).tag;
  if (place.cv < 0) return from;
  const std::string& cv = names.cv(place.cv).tag;
  return from.empty() ? cv : from + " \u2192 " + cv;
}

std::string cause_text(const Subject& subject) {
  const std::string kind = subject.cause->kind();
  if (subject.cause->name().text == std::string("unmodelled_input")) return "missing input";
  if (kind.empty()) return lower(subject.cause->name().title);
  if (kind == "polynomial" || kind == "saturation" || kind == "two_sided" || kind == "product")
    return lower(subject.cause->name().title);
  return spaced(kind);
}

std::string short_text(const DiagnosisRun& run, const Finding& finding) {
  const auto is_error = [](const Parameter& each) {
    return each.quantity == &kGainRatio || each.quantity == &kTimeConstantRatio ||
           each.quantity == &kDeadTimeError;
  };
  const std::vector<Parameter>& parameters = finding.parameters;
  std::string text;
  if (!parameters.empty() && std::all_of(parameters.begin(), parameters.end(), is_error)) {
    for (const Parameter& parameter : parameters) {
      const ParameterText said = parameter_text(run, finding, parameter);
      text += (text.empty() ? "" : ", ") + said.name + " " + said.value;
    }
    return text;
  }
  text = cause_text(finding.subject);
  if (text == "step" && !finding.onset_s) text = "offset";  // throughout the data
  for (const char* telling : {"size", "width", "band", "value", "variance_ratio"})
    for (const Parameter& parameter : parameters) {
      if (parameter.name() != telling) continue;
      const std::string value = parameter_text(run, finding, parameter).value;
      return text + " " + (parameter.name() == "size" ? signed_text(value) : value);
    }
  return text;
}

nlohmann::ordered_json matrix_json(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
  const std::vector<Finding>& findings = run.diagnosis.findings;
  const int own = run.unit.counts().inputs(), cvs = run.unit.counts().cv;
  std::vector<int> columns(static_cast<std::size_t>(own));
  for (int input = 0; input < own; ++input) columns[static_cast<std::size_t>(input)] = input;
  for (const Finding& finding : findings)
    if (const int column = column_of(run, finding);
        column >= own && std::find(columns.begin(), columns.end(), column) == columns.end())
      columns.push_back(column);

  const auto here = [&](int cv, int column) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < findings.size(); ++i)
      if (findings[i].subject.place.cv == cv && column_of(run, findings[i]) == column)
        numbers.push_back(i);
    return numbers;
  };
  const auto any_in = [&](int cv, int column) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& each) {
      return (cv == -1 && each.subject.place.cv < 0) ||
             (column == -1 && each.subject.place.cv >= 0 && column_of(run, each) < 0);
    });
  };

  Json json{{"inputs", Json::array()}, {"rows", Json::array()}};
  for (const int column : columns)
    json["inputs"].push_back(column < own
                                 ? names.input(column).tag
                                 : names.aux.at(static_cast<std::size_t>(column - own)).tag);
  const bool alone = any_in(0, -1);
  if (alone) json["inputs"].push_back("by itself");
  const auto add_row = [&](const std::string& tag, int cv) {
    Json row{{"tag", tag}, {"cells", Json::array()}};
    for (const int column : columns) {
      const std::vector<std::size_t> numbers = here(cv, column);
      if (!numbers.empty())
        row["cells"].push_back(finding_cell(run, numbers));
      else
        row["cells"].push_back(cv < 0 || column >= own ? cell("none", "")
                                                       : estimate_cell(run, cv, column));
    }
    if (alone) {
      const std::vector<std::size_t> numbers = here(cv, -1);
      row["cells"].push_back(numbers.empty() ? cell("none", "") : finding_cell(run, numbers));
    }
    json["rows"].push_back(std::move(row));
  };
  if (any_in(-1, 0)) add_row("all CVs", -1);
  for (int cv = 0; cv < cvs; ++cv) add_row(names.cv(cv).tag, cv);
  return json;
}

nlohmann::ordered_json matrix_json(const IdentificationRun& run) {
  Json json{{"inputs", run.unit.input_tags()}, {"rows", Json::array()}};
  for (const std::string& tag : run.unit.cv_tags())
    json["rows"].push_back(
        {{"tag", tag},
         {"cells", std::vector<Json>(run.unit.input_tags().size(), cell("none", ""))}});
  for (const ChannelAnswer& answer : run.identification.channels) {
    Json& place = json["rows"].at(static_cast<std::size_t>(answer.cv))["cells"].at(
        static_cast<std::size_t>(answer.input));
    switch (answer.left_out) {
      case LeftOut::kIdentified:
        place = cell("right",
                     "gain " + rounded(answer.dynamics->gain, answer.gain.low, answer.gain.high));
        break;
      case LeftOut::kGivenNone:
      case LeftOut::kNoRelation:
        place = cell("none", spaced(reason_word(answer.left_out)));
        break;
      default:
        place = cell("doubt", spaced(reason_word(answer.left_out)));
    }
  }
  return json;
}

}  // namespace mpm::report
