#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/mismatch/verdict.hpp"
#include "core/record/control_room_view.hpp"
#include "core/record/field_key.hpp"
#include "core/text/words.hpp"

namespace mpm {

/// A fitted number with its 95 % interval; names and units as in report.json.
struct CauseParameter {
  std::string name;
  double value = 0.0, low = 0.0, high = 0.0;

  template <class Archive>
  void archive(Archive& a) {
    a(name, value, low, high);
  }
};

/// The intervals of parameters, for JSON, which has them beside the values.
struct CauseIntervals {
  const std::vector<CauseParameter>& parameters;
};

/// What a diagnosis says of an alarm.
struct NamedCause {
  std::optional<std::string> cause;  ///< as in report.json; none where none is named
  std::string text;                  ///< the same for a person; empty before the first diagnosis
  double confidence = 0.0;
  std::vector<CauseParameter> parameters;

  template <class Archive>
  void archive(Archive& a) {
    a(cause, text, confidence);
    a.varying(parameters);
  }
};

enum class AlarmChange : std::uint8_t {
  kCleared,
  kActive,
  kDiagnosed,  ///< still active, now with a cause
};

[[nodiscard]] constexpr auto words_of(AlarmChange) {
  return std::array{"cleared", "active", "diagnosed"};
}

/// A channel's alarm changed; topic mpm/alarm_event. In JSON `record` is "diagnosis" where it was
/// diagnosed, else "alarm": the alarms of a journal and of `mpm watch` are the same lines, whether
/// or not somebody had time for a diagnosis.
struct AlarmRecord : AlarmEvidence {
  std::string unit, mv, cv;  ///< tags; `mv` may be a DV's
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  AlarmChange to = AlarmChange::kCleared;
  NamedCause named;

  /// Of the same channel.
  template <class Archive>
  void archive(Archive& a) {
    // not archived: unit, mv, cv (construction)
    AlarmEvidence::archive(a);
    a(interval, named);
    a.time(source_time_ns);
    a.within(to, AlarmChange::kCleared, AlarmChange::kDiagnosed);
  }

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    const bool diagnosed = !record.named.text.empty();
    visit("record", std::string_view(record.to == AlarmChange::kDiagnosed ? "diagnosis" : "alarm"));
    visit("unit", record.unit, sample.unit...);
    visit("interval", record.interval, sample.interval...);
    visit("time_ns", record.source_time_ns, sample.source_time_ns...);
    visit("mv", record.mv, sample.mv...);
    visit("cv", record.cv, sample.cv...);
    visit("to", record.to, change_of(sample)...);
    visit("p_value", record.p_value, sample.p_value...);
    visit("statistic", record.statistic, sample.statistic...);
    visit("threshold", record.threshold, sample.threshold...);
    visit("partial_correlation", record.partial_correlation, sample.partial_correlation...);
    visit("lag", record.lag, sample.lag...);
    visit("effect_size", record.effect_size, sample.effect_size...);
    visit({"cause", diagnosed}, record.named.cause, sample.cause...);
    visit({"cause_text", diagnosed}, record.named.text, sample.cause_text...);
    visit({"cause_confidence", diagnosed}, record.named.confidence, sample.cause_confidence...);
    visit({"cause_parameters", diagnosed}, record.named.parameters, sample.cause_parameters...);
    visit({"cause_intervals", diagnosed}, CauseIntervals{record.named.parameters});
  }

 private:
  // The samples of the two topics differ in this name alone.
  template <class Sample>
  static auto& change_of(Sample& sample) {
    if constexpr (requires { sample.to; })
      return sample.to;
    else
      return sample.state;
  }
};

/// The alarm of a channel as it stands, told apart from a change of it; topic mpm/alarm.
struct AlarmStateRecord : AlarmRecord {
  AlarmStateRecord() = default;
  /// What holds after `change`.
  explicit AlarmStateRecord(AlarmRecord change) : AlarmRecord(std::move(change)) {
    if (to == AlarmChange::kDiagnosed) to = AlarmChange::kActive;
  }

  ControlRoomView view;

  /// The rest of the view is what people and time have made of the alarm since.
  template <class Archive>
  void archive(Archive& a) {
    AlarmRecord::archive(a);
    a(view.message);
  }

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    AlarmRecord::fields(visit, record, sample...);
    ControlRoomView::fields(visit, record.view, sample...);
  }
};

}  // namespace mpm
