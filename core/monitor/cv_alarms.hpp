#pragma once

#include <cstdint>
#include <vector>

#include "core/alarm/condition.hpp"
#include "core/mismatch/change_scan.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/monitor/belief.hpp"

namespace mpm {

/// The alarms of one CV's channels, and what follows from them.
///
/// An alarm rises where an error that matters is beyond doubt in some memory. Was the error there
/// all along, then the memory is of one piece and its evidence stands. Did it begin inside the
/// memory (`ChangeScan`), then no constant model fits the memory and healthy channels would be
/// blamed too: only the strongest alarm rises, the CV forgets what was before the change, and it is
/// `isolating` until enough samples have come since then. What the fresh memory then confirms stays
/// or rises; the rest clears at once, but for channels that say nothing: no alarm clears where an
/// error of interest would not show. While an alarm stands the fast memory is watched: where it
/// disagrees with the long one, something changed again (a return to normal as a rule) and the CV
/// forgets once more.
///
/// Before anything rises or a change is believed, it is asked whether the CV's answer depends on
/// where the plant is operated (`Curvature`); if that explains more, no channel is blamed for it.
class CvAlarms {
 public:
  /// `shown_index`: an error of interest shows up to that excitation index.
  CvAlarms(int inputs, double shown_index)
      : shown_index_(shown_index), conditions_(static_cast<std::size_t>(inputs)) {
    before_.reserve(conditions_.size());
  }

  /// After each sample; `evaluated`: the CV's evidence is new. Evidence beyond `belief` raises
  /// nothing. Calls `changed(input)` for each alarm that rose or cleared.
  template <class Changed>
  void update(int cv, bool evaluated, MismatchDetector& detector, ChangeScan& scan,
              const Condition::Limits& limits, const Belief& belief, Changed changed) {
    belief_ = belief;
    before_.clear();
    for (const Condition& condition : conditions_) before_.push_back(condition.state());
    step(cv, evaluated, detector, scan, limits);
    for (std::size_t i = 0; i < conditions_.size(); ++i)
      if (conditions_[i].state() != before_[i]) changed(static_cast<int>(i));
  }
  /// An alarm that another monitor of the unit raised: it stands until this one's own evidence
  /// clears it.
  void stand(int input) { set(input, AlarmState::kActive); }
  /// As somebody else judges the CV.
  void set(int input, AlarmState state) { conditions_[static_cast<std::size_t>(input)].set(state); }
  /// A sample without any verdict of this CV.
  void hold();
  /// It is no channel that is wrong. Calls `changed(input)` for each alarm that cleared.
  template <class Changed>
  void clear(Changed changed) {
    isolating_ = false;
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      if (conditions_[i].state() == AlarmState::kCleared) continue;
      conditions_[i].set(AlarmState::kCleared);
      changed(static_cast<int>(i));
    }
  }

  [[nodiscard]] AlarmState state(int input) const {
    return conditions_[static_cast<std::size_t>(input)].state();
  }
  [[nodiscard]] bool any() const;
  [[nodiscard]] bool isolating() const { return isolating_; }
  /// Since which the CV is isolating.
  [[nodiscard]] const ChangePoint& change() const { return change_; }

  template <class Archive>
  void archive(Archive& a) {
    // not archived: shown_index_ (construction)
    // not archived: before_, belief_ (empty between calls)
    a(conditions_, isolating_, change_, since_scan_);
  }

 private:
  void step(int cv, bool evaluated, MismatchDetector& detector, ChangeScan& scan,
            const Condition::Limits& limits);
  [[nodiscard]] Belief belief(std::size_t input) const;
  void look_for_change(int cv, bool risen, MismatchDetector& detector, ChangeScan& scan);
  void settle(int cv, const MismatchDetector& detector, const Condition::Limits& limits);
  [[nodiscard]] bool something_wrong(int cv, bool quiet, const MismatchDetector& detector) const;
  [[nodiscard]] bool memories_disagree(int cv, const MismatchDetector& detector,
                                       const Condition::Limits& limits) const;
  [[nodiscard]] bool certain(const ChangePoint& change, bool risen) const;

  double shown_index_;
  std::vector<Condition> conditions_;
  std::vector<AlarmState> before_;
  bool isolating_ = false;
  Belief belief_;
  ChangePoint change_;
  std::int64_t since_scan_ = 0;
};

}  // namespace mpm
