#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "idl/topics.hpp"

namespace mpm::idl {

template <class T>
concept Number = std::is_arithmetic_v<T>;

/// Makes samples of records. A sample borrows from its record, and from here what DDS wants in
/// another form: it is valid until either changes.
class SampleMaker {
 public:
  template <class Record>
  [[nodiscard]] SampleOf<Record> sample_of(const Record& record) {
    SampleOf<Record> sample{};
    kept_.clear();
    Record::fields(*this, record, sample);
    return sample;
  }

  // One row of a list of fields.
  void operator()(const FieldKey&, const auto& member, auto&& sample) { put(member, sample); }
  void operator()(const FieldKey&, const auto&) const {}  // in JSON only

 private:
  template <Number T>
  static void put(T value, T& sample) {
    sample = value;
  }
  template <Worded Enum>
  static void put(Enum value, char*& sample) {
    sample = borrow(to_string(value).data());
  }
  static void put(AlarmState state, bool& active) { active = state == AlarmState::kActive; }
  static void put(const std::string& text, char*& sample) { sample = borrow(text.c_str()); }
  static void put(const std::optional<std::string>& text, char*& sample);
  static void put(const std::vector<double>& values, dds_sequence_double& sample);
  void put(const std::vector<CauseParameter>& values, dds_sequence_mpm_CauseParameter& sample);
  void put(const std::tuple<const Reason&, const std::string&>& reason, char*& sample);
  template <HasFields Part, class Sample>
  void put(const Part& part, Sample& sample) {
    Part::fields(*this, part, sample);
  }
  template <HasFields Part, class Sequence>
  void put(const std::vector<Part>& parts, Sequence& sample) {
    using Element = std::remove_pointer_t<decltype(sample._buffer)>;
    const auto elements = std::make_shared<std::vector<Element>>(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) put(parts[i], (*elements)[i]);
    kept_.push_back(elements);
    const auto count = static_cast<std::uint32_t>(elements->size());
    sample = {count, count, elements->data(), false};
  }
  template <class... Member, class... Sample>
  void put(const std::tuple<Member...>& members, const std::tuple<Sample...>& samples) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (put(std::get<I>(members), std::get<I>(samples)), ...);
    }
    (std::index_sequence_for<Member...>());
  }

  // The C types have no const; writing does not touch what they point to.
  static char* borrow(const char* text) { return const_cast<char*>(text); }

  std::string reason_;
  std::vector<mpm_CauseParameter> parameters_;
  std::vector<std::shared_ptr<const void>> kept_;  // what sequences point to
};

/// Makes records of samples, those of another make too: strings may be missing, and a word that is
/// not known here reads as the first of its enumeration (undetermined, no reason, cleared).
class RecordMaker {
 public:
  // One row of a list of fields.
  void operator()(const FieldKey&, auto&& member, const auto& sample) const {
    take(sample, member);
  }
  void operator()(const FieldKey&, const auto&) const {}  // in JSON only

 private:
  template <Number T>
  static void take(T sample, T& value) {
    value = sample;
  }
  template <Worded Enum>
  static void take(const char* sample, Enum& value) {
    value = from_string<Enum>(or_empty(sample)).value_or(Enum{});
  }
  static void take(bool active, AlarmState& state) {
    state = active ? AlarmState::kActive : AlarmState::kCleared;
  }
  static void take(const char* sample, std::string& text) { text = or_empty(sample); }
  static void take(const char* sample, std::optional<std::string>& text);
  static void take(const dds_sequence_double& sample, std::vector<double>& values);
  static void take(const dds_sequence_mpm_CauseParameter& sample,
                   std::vector<CauseParameter>& values);
  static void take(const char* sample, std::tuple<Reason&, std::string&> reason);
  template <HasFields Part>
  static void take(const auto& sample, Part& part) {
    Part::fields(RecordMaker(), part, sample);
  }
  template <HasFields Part>
  static void take(const auto& sample, std::vector<Part>& parts) {
    parts.resize(sample._length);
    for (std::size_t i = 0; i < parts.size(); ++i) take(sample._buffer[i], parts[i]);
  }
  template <class... Sample, class... Member>
  static void take(const std::tuple<Sample...>& samples, const std::tuple<Member...>& members) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (take(std::get<I>(samples), std::get<I>(members)), ...);
    }
    (std::index_sequence_for<Member...>());
  }

  static const char* or_empty(const char* text) { return text == nullptr ? "" : text; }
};

template <class Record>
[[nodiscard]] Record record_of(const SampleOf<Record>& sample) {
  Record record;
  Record::fields(RecordMaker(), record, sample);
  return record;
}

}  // namespace mpm::idl
