#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "idl/output_samples.hpp"
#include "idl/reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::idl {

/// The daemon that wrote this is gone; what it said last no longer holds.
struct MonitorGone {
  std::string unit;
};

/// The order of a unit's tags, from the control system.
struct LayoutRecord {
  std::string unit;
  std::string kind;
  std::vector<std::string> tags;
};
[[nodiscard]] LayoutRecord layout_record(const mpm_Layout& sample);

template <class Records>
class ReadersOf;

template <class... Record>
class ReadersOf<std::tuple<Record...>> {
 public:
  using Output = std::variant<LayoutRecord, Record..., MonitorGone>;

  enum class Scope {
    kEverything,
    kAlarms,  ///< the alarm topics only: no other reader exists
  };

  explicit ReadersOf(const Participant& participant, Scope scope = Scope::kEverything) {
    (open<Record>(participant, scope), ...);
    if (scope == Scope::kEverything) layouts_.emplace(participant, kLayoutTopic, layout_qos());
  }

  void attach_to(WaitSet& wait_set) const {
    const auto attach = [&](const auto& reader) {
      if (reader) wait_set.attach(reader->readable());
    };
    std::apply([&](const auto&... reader) { (attach(reader), ...); }, readers_);
    attach(layouts_);
  }

  /// Takes what is there; valid until the next call.
  [[nodiscard]] const std::vector<Output>& take() {
    taken_.clear();
    // From the last, so that of what one frame caused the channels are never behind the alarms.
    [this]<std::size_t... I>(std::index_sequence<I...>) {
      (this->template take_records<
           std::tuple_element_t<sizeof...(Record) - 1 - I, std::tuple<Record...>>>(),
       ...);
    }
    (std::index_sequence_for<Record...>());
    take_layouts();
    std::stable_sort(taken_.begin(), taken_.end(),
                     [](const Taken& a, const Taken& b) { return a.written_ns < b.written_ns; });
    sorted_.clear();
    writers_.clear();
    for (Taken& taken : taken_) {
      sorted_.push_back(std::move(taken.output));
      writers_.push_back(taken.writer);
    }
    return sorted_;
  }
  /// Who wrote what was taken last, one by one, as in SampleInfo.
  [[nodiscard]] const std::vector<std::uint64_t>& writers() const { return writers_; }

 private:
  struct Taken {
    std::int64_t written_ns = 0;
    std::uint64_t writer = 0;
    Output output;
  };

  template <class One>
  using OptionalReader = std::optional<Reader<SampleOf<One>>>;

  template <class One>
  void open(const Participant& participant, Scope scope) {
    using Topic = OutputTopic<One>;
    if (scope == Scope::kAlarms && !std::is_base_of_v<AlarmRecord, One>) return;
    std::get<OptionalReader<One>>(readers_).emplace(participant, Topic::kName, Topic::kReaderQos(),
                                                    Topic::kBatch);
  }

  template <class One>
  void take_records() {
    auto& reader = std::get<OptionalReader<One>>(readers_);
    if (!reader) return;
    reader->take_with_info([this](const SampleOf<One>& sample, const SampleInfo& info) {
      if (info.valid)
        taken_.push_back({info.source_time_ns, info.writer, record_of<One>(sample)});
      else if (std::is_same_v<One, HealthRecord> && sample.unit != nullptr)
        taken_.push_back({info.source_time_ns, info.writer, MonitorGone{sample.unit}});
    });
  }

  void take_layouts() {
    if (!layouts_) return;
    layouts_->take_with_info([this](const mpm_Layout& sample, const SampleInfo& info) {
      if (info.valid)  // first: it orders the rest
        taken_.push_back({0, info.writer, layout_record(sample)});
    });
  }

  std::tuple<OptionalReader<Record>...> readers_;
  std::optional<Reader<mpm_Layout>> layouts_;
  std::vector<Taken> taken_;
  std::vector<Output> sorted_;
  std::vector<std::uint64_t> writers_;  // of sorted_
};

/// Reads what daemons say, in the order in which they said it.
using OutputReaders = ReadersOf<OutputRecords>;
using Output = OutputReaders::Output;

}  // namespace mpm::idl
