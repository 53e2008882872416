#pragma once

#include <tuple>

#include "idl/output_samples.hpp"
#include "idl/writer.hpp"

namespace mpm::idl {

/// Writes one kind of records to their topic.
template <class Record>
class OutputWriter {
 public:
  explicit OutputWriter(const Participant& participant)
      : writer_(participant, OutputTopic<Record>::kName, OutputTopic<Record>::kWriterQos()) {}

  [[nodiscard]] bool write(const Record& record) const {
    SampleMaker maker;
    return writer_.write(maker.sample_of(record));
  }
  [[nodiscard]] int matched_readers() const { return writer_.matched_readers(); }

 private:
  Writer<SampleOf<Record>> writer_;
};

template <class Records>
class WritersOf;

template <class... Record>
class WritersOf<std::tuple<Record...>> {
 public:
  explicit WritersOf(const Participant& participant)
      : writers_(OutputWriter<Record>(participant)...) {}

  template <class Any>
  [[nodiscard]] bool write(const Any& record) const {
    return std::get<OutputWriter<Any>>(writers_).write(record);
  }

 private:
  std::tuple<OutputWriter<Record>...> writers_;
};

/// Everything the daemon ever writes on one domain, all units. None of these waits for a reader;
/// false means that the sample could not be handed over.
using OutputWriters = WritersOf<OutputRecords>;

}  // namespace mpm::idl
