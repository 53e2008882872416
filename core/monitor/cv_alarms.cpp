#include "core/monitor/cv_alarms.hpp"

#include <algorithm>

#include "core/monitor/calibration.hpp"

namespace mpm {
namespace {

namespace change_search = calibration::change_search;

// Of all memories that say something.
struct Evidence {
  double material = 1.0;   // p-value of "within the limits", times the memories asked
  double any = 1.0;        // p-value of "no error", likewise
  bool harmless = true;    // the long memory is sure that the error is within the limits
  bool shown = true;       // or would show one of interest
  bool elsewhere = false;  // it says that the error is another CV's
};

Evidence combined(int cv, int input, const MismatchDetector& detector, const Belief& belief,
                  double shown_index) {
  Evidence evidence;
  int ready = 0;
  for (int m = 0; m < detector.memory_count(); ++m) {
    if (!detector.memory(cv, m).ready()) continue;
    ++ready;
    const ChannelEvidence& channel = detector.evidence(cv, input, m);
    if (!belief.has(channel)) continue;
    evidence.material = std::min(evidence.material, channel.p_value_material);
    evidence.any = std::min(evidence.any, channel.p_value);
  }
  evidence.harmless = detector.evidence(cv, input).harmless;
  evidence.shown = detector.evidence(cv, input).excitation_index <= shown_index;
  evidence.elsewhere = detector.evidence(cv, input).elsewhere;
  evidence.material = std::min(1.0, ready * evidence.material);
  evidence.any = std::min(1.0, ready * evidence.any);
  return evidence;
}

// What the condition looks at: to raise, that there is an error, and that it matters; to clear,
// that it does not matter, is another CV's, or is not there and would have shown.
double condition_p(const Evidence& evidence, AlarmState state) {
  if (state == AlarmState::kCleared)
    return evidence.material < calibration::alarms::kMattersPValue
               ? evidence.any
               : std::max(evidence.any, evidence.material);
  const bool there = evidence.any < calibration::alarms::kStaysPValue || !evidence.shown;
  return there && !evidence.harmless && !evidence.elsewhere ? 0.0 : evidence.material;
}

}  // namespace

bool CvAlarms::any() const {
  return std::any_of(conditions_.begin(), conditions_.end(), [](const Condition& condition) {
    return condition.state() == AlarmState::kActive;
  });
}

// What is not believed raises nothing; a standing alarm clears on evidence of any kind.
Belief CvAlarms::belief(std::size_t input) const {
  return conditions_[input].state() == AlarmState::kActive ? Belief{} : belief_;
}

void CvAlarms::hold() {
  for (Condition& condition : conditions_) condition.hold();
}

void CvAlarms::step(int cv, bool evaluated, MismatchDetector& detector, ChangeScan& scan,
                    const Condition::Limits& limits) {
  ++since_scan_;
  if (!detector.memory(cv).ready()) return hold();
  if (isolating_) {
    if (!evaluated) return;
    isolating_ = false;
    settle(cv, detector, limits);
    return;
  }
  const bool quiet = !any();
  bool risen = false;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    const AlarmState before = conditions_[i].state();
    const Evidence evidence = combined(cv, static_cast<int>(i), detector, belief(i), shown_index_);
    const bool changed = conditions_[i].update(condition_p(evidence, before), limits);
    risen = risen || (changed && before == AlarmState::kCleared);
  }
  const bool urgent = detector.regression(cv).noise().surprise() > change_search::kUrgentSurprise;
  const bool due = evaluated && since_scan_ >= (urgent ? change_search::kBetweenUrgent
                                                       : change_search::kBetween);
  const bool suspicious =
      due && (something_wrong(cv, quiet, detector) || memories_disagree(cv, detector, limits));
  if (risen || suspicious) look_for_change(cv, risen, detector, scan);
}

void CvAlarms::look_for_change(int cv, bool risen, MismatchDetector& detector, ChangeScan& scan) {
  const bool quiet = std::none_of(before_.begin(), before_.end(),
                                  [](AlarmState state) { return state == AlarmState::kActive; });
  since_scan_ = 0;
  detector.fold(cv);
  const std::optional<ChangePoint> change = scan.scan(detector, cv);
  if (detector.take_in_curvature(cv, change ? change->gain : 0.0)) {
    // What rose just now rested on a model that knows one operating point.
    for (std::size_t i = 0; i < conditions_.size(); ++i) conditions_[i].set(before_[i]);
    change_ = {};
    isolating_ = true;
    return;
  }
  if (!change || !certain(*change, risen)) return;
  // Behind the change for sure: rows of before it are what the fresh memory must not know.
  detector.start_afresh(cv, change->samples - change->resolution);
  isolating_ = true;
  change_ = *change;
  if (!quiet || change->kind == ChangeKind::kEnded || !belief_.in_all()) return;
  // Of a change from quiet only the likeliest channel is blamed until the CV is isolated.
  for (std::size_t i = 0; i < conditions_.size(); ++i)
    conditions_[i].set(static_cast<int>(i) == change->input ? AlarmState::kActive
                                                            : AlarmState::kCleared);
}

bool CvAlarms::certain(const ChangePoint& change, bool risen) const {
  const bool ended = change.kind == ChangeKind::kEnded && any();
  return risen || ended || change.p_value < change_search::kCertainPValue;
}

void CvAlarms::settle(int cv, const MismatchDetector& detector, const Condition::Limits& limits) {
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    const Evidence evidence = combined(cv, static_cast<int>(i), detector, belief(i), shown_index_);
    const AlarmState before = conditions_[i].state();
    if (before == AlarmState::kActive && condition_p(evidence, before) > limits.clear_above)
      conditions_[i].set(AlarmState::kCleared);
    if (before == AlarmState::kCleared && condition_p(evidence, before) < limits.raise_below)
      conditions_[i].set(AlarmState::kActive);
  }
}

bool CvAlarms::something_wrong(int cv, bool quiet, const MismatchDetector& detector) const {
  if (detector.regression(cv).noise().surprise() > change_search::kSuspiciousSurprise) return true;
  if (!quiet) return false;
  for (std::size_t i = 0; i < conditions_.size(); ++i)
    if (combined(cv, static_cast<int>(i), detector, belief(i), shown_index_).any <
        change_search::kSuspiciousPValue)
      return true;
  return false;
}

bool CvAlarms::memories_disagree(int cv, const MismatchDetector& detector,
                                 const Condition::Limits& limits) const {
  for (int m = 1; m < detector.memory_count(); ++m) {
    if (!detector.memory(cv, m).ready()) continue;
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      const ChannelEvidence& fast = detector.evidence(cv, static_cast<int>(i), m);
      const ChannelEvidence& lasting = detector.evidence(cv, static_cast<int>(i));
      const bool active = conditions_[i].state() == AlarmState::kActive;
      if (active && fast.p_value_material > limits.clear_above &&
          lasting.p_value_material < limits.clear_above)
        return true;
    }
  }
  return false;
}

}  // namespace mpm
