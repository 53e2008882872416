#include "core/identify/diagnosis/seldom_read.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/split.hpp"
#include "core/model/model_part.hpp"

namespace mpm {
namespace {

constexpr const char* kReadSeldom =
    "every CV is read only once in several samples: let sample_time be as long";
constexpr const char* kOneReadSeldom =
    "a CV is read only once in several samples and was not judged beside the others: give it a "
    "unit of its own, with a sample_time as long";

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where a CV of the whole is among those of the part; -1: it is not.
int place_in(const std::vector<int>& cvs, int cv) {
  const auto found = std::lower_bound(cvs.begin(), cvs.end(), cv);
  return found != cvs.end() && *found == cv ? static_cast<int>(found - cvs.begin()) : -1;
}

/// Puts the part's in the place of those that the whole has of these CVs; `inputs`: where each of
/// the part's inputs is in the whole.
template <class Item>
void put_in(const std::vector<Item>& part, const std::vector<int>& cvs,
            const std::vector<int>& inputs, std::vector<Item>& whole) {
  std::erase_if(whole, [&](const Item& item) { return place_in(cvs, item.cv) >= 0; });
  for (Item item : part) {
    item.cv = cvs[static_cast<std::size_t>(item.cv)];
    if constexpr (requires { item.input; })
      item.input = inputs[static_cast<std::size_t>(item.input)];
    whole.push_back(std::move(item));
  }
  std::stable_sort(whole.begin(), whole.end(),
                   [](const Item& a, const Item& b) { return a.cv < b.cv; });
}

class Lift {
 public:
  /// `aux`: signals that no model uses, set-points not among them.
  Lift(const std::vector<int>& cvs, int aux) : cvs_(cvs), aux_(aux) {}

  void operator()(int& cv) const {
    if (cv >= 0) cv = cvs_[static_cast<std::size_t>(cv)];
  }
  void operator()(Subject& subject) const {
    (*this)(subject.place.cv);
    if (subject.place.aux < aux_) return;
    int of = subject.place.aux - aux_;  // a set-point's CV
    (*this)(of);
    subject.place.aux = aux_ + of;
  }
  void operator()(Finding& finding) const {
    (*this)(finding.subject);
    for (Rival& rival : finding.rivals) (*this)(rival.subject);
    if (finding.with) (*this)(*finding.with);
  }

 private:
  const std::vector<int>& cvs_;
  int aux_;
};

/// With the aux signals that a model takes as inputs, and no others.
Recording with_inputs(const Recording& recording, const std::vector<int>& new_inputs) {
  Recording result = recording;
  result.aux.resize(recording.samples(), static_cast<Index>(new_inputs.size()));
  for (std::size_t i = 0; i < new_inputs.size(); ++i)
    result.aux.col(static_cast<Index>(i)) = recording.aux.col(new_inputs[i]);
  return result;
}

/// Free runs of these CVs on all rows, in the numbers of the whole.
void run_again(const Extended& extended, const Recording& recording, const std::vector<int>& cvs,
               MatrixXd& runs) {
  const Recording given = with_inputs(recording, extended.new_inputs);
  Simulator simulator(given);
  for (const int cv : cvs) runs.col(cv) = free_run(simulator, extended.model, cv);
}

template <class Items>
void append(Items items, Items& to) {
  to.insert(to.end(), std::make_move_iterator(items.begin()), std::make_move_iterator(items.end()));
}

}  // namespace

Extended within(Extended whole, const Extended& part, const std::vector<int>& cvs, int inputs) {
  std::vector<int> where;
  for (int input = 0; input < part.model.input_count; ++input) {
    if (input < inputs) {
      where.push_back(input);
      continue;
    }
    const int aux = part.new_inputs[static_cast<std::size_t>(input - inputs)];
    const auto known = std::find(whole.new_inputs.begin(), whole.new_inputs.end(), aux);
    where.push_back(inputs + static_cast<int>(known - whole.new_inputs.begin()));
    if (known != whole.new_inputs.end()) continue;
    whole.new_inputs.push_back(aux);
    ++whole.model.input_count;
    whole.model.input_blocks.emplace_back();
    whole.model.input_origin.conservativeResize(whole.model.input_count);
    whole.model.input_origin(whole.model.input_count - 1) = part.model.input_origin(input);
  }
  ModelSpec& model = whole.model;
  std::vector<ChannelSpec> channels = part.model.channels;
  for (ChannelSpec& channel : channels) {
    const auto from = static_cast<std::size_t>(channel.input);
    const bool known = model.input_blocks[static_cast<std::size_t>(where[from])].has_value();
    if (!known && !channel.input_block) channel.input_block = part.model.input_blocks[from];
  }
  put_in(channels, cvs, where, model.channels);
  put_in(part.model.state_terms, cvs, where, model.state_terms);
  put_in(part.model.disturbances, cvs, where, model.disturbances);
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    model.output_blocks[static_cast<std::size_t>(cvs[i])] = part.model.output_blocks[i];
    model.output_origin(cvs[i]) = part.model.output_origin(static_cast<Index>(i));
  }
  return whole;
}

namespace {

/// With no CV judged: all are simulated and scored, on what comes after the first `fitted` rows or
/// on the second recording.
Diagnosis unjudged(const ModelSpec& model, const Recorded& data, Index fitted) {
  Diagnosis diagnosis;
  diagnosis.samples = data.recording.samples();
  diagnosis.fit_samples = fitted;
  diagnosis.validation_samples =
      data.validation != nullptr ? data.validation->samples() : diagnosis.samples - fitted;
  diagnosis.extended = model;
  Simulator first(data.recording);
  diagnosis.before = diagnosis.after = free_runs(first, model);
  if (data.validation != nullptr) {
    Simulator second(*data.validation);
    diagnosis.validation_before = diagnosis.validation_after = free_runs(second, model);
  }
  const bool other = data.validation != nullptr;
  const MatrixXd& measured = other ? data.validation->cvs : data.recording.cvs;
  const MatrixXd& runs = other ? diagnosis.validation_before : diagnosis.before;
  const Index rows = diagnosis.validation_samples;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const VectorXd simulated = runs.col(cv).tail(rows);
    diagnosis.scores.push_back(score(measured.col(cv).tail(rows), simulated, simulated, 1, 0));
    diagnosis.scores.back().judged = false;
  }
  return diagnosis;
}

/// Takes the diagnosis of a part into that of the whole, in the numbers of the whole.
void take_in(const ModelSpec& model, const Recorded& data, const Readings& readings, Diagnosis part,
             Diagnosis& whole) {
  const std::vector<int>& cvs = readings.cvs;
  const Lift lift(cvs, static_cast<int>(data.recording.aux.cols()));
  for (auto* findings : {&part.findings, &part.refused, &part.small})
    for (Finding& finding : *findings) lift(finding);
  for (Unexplained& unexplained : part.unexplained) lift(unexplained.subject);
  for (ChannelEstimate& channel : part.channels) lift(channel.cv);
  for (auto* places : {&part.rejected, &part.bent})
    for (Place& place : *places) lift(place.cv);
  if (part.suspect) lift(*part.suspect);
  // What an actuator does all CVs see: it is said once, by those that see it best.
  std::erase_if(part.findings, [&](Finding& finding) {
    if (finding.subject.place.cv >= 0) return false;
    const auto same =
        std::find_if(whole.findings.begin(), whole.findings.end(),
                     [&](const Finding& other) { return other.subject == finding.subject; });
    if (same == whole.findings.end()) return false;
    if (finding.evidence > same->evidence) *same = std::move(finding);
    return true;
  });
  append(std::move(part.findings), whole.findings);
  append(std::move(part.refused), whole.refused);
  append(std::move(part.small), whole.small);
  append(std::move(part.unexplained), whole.unexplained);
  append(std::move(part.channels), whole.channels);
  append(std::move(part.rejected), whole.rejected);
  append(std::move(part.bent), whole.bent);
  std::stable_sort(whole.findings.begin(), whole.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.evidence > b.evidence; });
  if (part.suspect && (!whole.suspect || whole.suspect->evidence < part.suspect->evidence))
    whole.suspect = std::move(part.suspect);
  for (std::size_t i = 0; i < part.inputs.size(); ++i) {
    if (i == whole.inputs.size()) whole.inputs.push_back(part.inputs[i]);
    whole.inputs[i].excited = whole.inputs[i].excited || part.inputs[i].excited;
  }
  if (part.before.rows() == 0) return;  // nothing was judged

  for (std::size_t i = 0; i < cvs.size(); ++i) {
    for (Horizon& horizon : part.scores[i].horizons)
      horizon.samples =
          static_cast<Index>(std::round(static_cast<double>(horizon.samples) * readings.every));
    whole.scores[static_cast<std::size_t>(cvs[i])] = std::move(part.scores[i]);
  }
  const Extended extended =
      within({std::move(whole.extended), std::move(whole.new_inputs)},
             {std::move(part.extended), std::move(part.new_inputs)}, cvs, model.input_count);
  whole.extended = extended.model;
  whole.new_inputs = extended.new_inputs;
  if (readings.every > 1.0) {
    run_again(extended, data.recording, cvs, whole.after);
    if (data.validation != nullptr)
      run_again(extended, *data.validation, cvs, whole.validation_after);
    return;
  }
  append(std::move(part.unanswered), whole.unanswered);
  append(std::move(part.validation_unanswered), whole.validation_unanswered);
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    const auto at = static_cast<Index>(i);
    whole.before.col(cvs[i]) = part.before.col(at);
    whole.after.col(cvs[i]) = part.after.col(at);
    if (data.validation == nullptr) continue;
    whole.validation_before.col(cvs[i]) = part.validation_before.col(at);
    whole.validation_after.col(cvs[i]) = part.validation_after.col(at);
  }
}

/// CVs that are read in one cycle.
struct Cycle {
  const Readings& readings;
  ModelSpec own;  ///< at its own sample time
  std::optional<ModelSpec> model;
  Recording recording;
  std::optional<Recording> validation;

  [[nodiscard]] bool can_be_judged(bool validated) const {
    if (!model || (validated && !validation)) return false;
    return readings.every == 1.0 ||
           (recording.samples() >= needed_samples(*model) && is_linear(*model));
  }
};

Cycle cycle_of(const ModelSpec& model, const Recorded& data, const Readings& readings) {
  Cycle cycle{readings, of_cvs(model, readings.cvs), of_readings(model, readings), {}, {}};
  cycle.recording = of_readings(model, data.recording, readings);
  if (data.validation == nullptr) return cycle;
  if (const auto there = readings_in(*data.validation, readings))
    cycle.validation = of_readings(model, *data.validation, *there);
  return cycle;
}

}  // namespace

Diagnosis by_readings(const ModelSpec& model, const Recorded& data,
                      const std::vector<Readings>& all, const DiagnosisSettings& settings,
                      const Judge& judge) {
  std::optional<Diagnosis> whole;
  DiagnosisVerdict verdict = DiagnosisVerdict::kMatch;
  std::string reason;
  std::size_t judged = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Readings& readings = all[i];
    if (readings.cvs.empty()) continue;
    const Cycle cycle = cycle_of(model, data, readings);
    if (!cycle.can_be_judged(data.validation != nullptr)) continue;
    judged += readings.cvs.size();
    DiagnosisSettings of_part = settings;
    of_part.progress = [&](double share) {
      return settings.progress((static_cast<double>(i) + share) / static_cast<double>(all.size()));
    };
    Diagnosis part = judge(cycle.own,
                           {*cycle.model, readings.every, cycle.recording,
                            cycle.validation ? &*cycle.validation : nullptr},
                           of_part);
    if (!whole)
      whole = unjudged(model, data,
                       data.validation != nullptr ? data.recording.samples()
                       : readings.every == 1.0 && part.fit_samples > 0
                           ? part.fit_samples
                           : fitted_rows(data.recording, settings.fit_share));
    if (part.verdict == DiagnosisVerdict::kMismatch || verdict == DiagnosisVerdict::kMatch)
      verdict = part.verdict;
    if (reason.empty()) reason = part.reason;
    take_in(model, data, readings, std::move(part), *whole);
  }
  const char* unread = all.front().cvs.empty() ? kReadSeldom : kOneReadSeldom;
  if (!whole) {
    Diagnosis diagnosis;
    diagnosis.samples = data.recording.samples();
    diagnosis.extended = model;
    diagnosis.reason = unread;
    return diagnosis;
  }
  const bool all_judged = static_cast<int>(judged) == model.cv_count;
  if (!all_judged && verdict == DiagnosisVerdict::kMatch) verdict = DiagnosisVerdict::kUndetermined;
  if (!all_judged && reason.empty()) reason = unread;
  whole->verdict = verdict;
  whole->reason = reason;
  return *std::move(whole);
}

}  // namespace mpm
