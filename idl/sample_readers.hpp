#pragma once

#include <array>

#include "idl/reader.hpp"
#include "idl/sample_view.hpp"
#include "idl/wait_set.hpp"

namespace mpm::idl {

/// Reads the input topics of all units of one participant.
class SampleReaders {
 public:
  /// `units`: as for a Reader.
  explicit SampleReaders(const Participant& participant, UnitChoice* units = nullptr)
      : readers_{
            make(participant, kTopicKinds[0], units), make(participant, kTopicKinds[1], units),
            make(participant, kTopicKinds[2], units), make(participant, kTopicKinds[3], units),
            make(participant, kTopicKinds[4], units), make(participant, kTopicKinds[5], units)} {}

  void attach_to(WaitSet& wait_set) const {
    for (const auto& reader : readers_) wait_set.attach(reader.readable());
  }

  /// Takes one batch per topic, so that none runs far ahead: `on_sample(const SampleView&)`.
  /// Returns how many samples were taken.
  template <class Callback>
  int take(Callback&& on_sample) {
    int count = 0;
    for (std::size_t i = 0; i < readers_.size(); ++i)
      count += readers_[i].take_with_info([&](const mpm_Sample& sample, const SampleInfo& info) {
        if (info.valid) on_sample(view_of(kTopicKinds[i], sample, info.writer));
      });
    return count;
  }

 private:
  static Reader<mpm_Sample> make(const Participant& participant, SignalKind kind,
                                 UnitChoice* units) {
    return {participant, sample_topic(kind), sample_reader_qos(), kBatch, units};
  }

  static constexpr int kBatch = 64;

  std::array<Reader<mpm_Sample>, kTopicKinds.size()> readers_;
};

}  // namespace mpm::idl
