#pragma once

#include <string>
#include <vector>

#include "idl/entity.hpp"
#include "idl/key_limit.hpp"
#include "idl/participant.hpp"
#include "idl/qos.hpp"
#include "idl/sample_info.hpp"
#include "idl/topics.hpp"
#include "idl/unit_choice.hpp"

namespace mpm::idl {

template <class T>
class Reader {
 public:
  /// `batch`: samples taken at once. Small, so that no topic runs far ahead of the others in a
  /// loop over several; or large enough for all there is, where order across instances matters.
  /// `units`: of which samples are taken, and must outlive the reader; null: of all.
  Reader(const Participant& participant, const char* topic, const Qos& qos, int batch = 64,
         UnitChoice* units = nullptr)
      : keys_(TopicType<T>::descriptor()->m_nkeys, units),
        topic_(topic_with(keys_, participant, *TopicType<T>::descriptor(), topic)),
        reader_(dds_create_reader(participant.get(), topic_.get(), qos.get(), nullptr),
                std::string("reader of ") + topic),
        readable_(dds_create_readcondition(reader_.get(), DDS_ANY_STATE), "read condition"),
        samples_(static_cast<std::size_t>(batch)),
        infos_(static_cast<std::size_t>(batch)) {}

  /// Takes a batch and calls `on_sample(const T&, const SampleInfo&)` for each sample. Where
  /// `info.valid` is false only the keys are set. Samples come instance by instance, within one in
  /// the order of writing. Returns how many were taken.
  template <class Callback>
  int take_with_info(Callback&& on_sample) {
    samples_[0] = nullptr;  // lend them, do not copy
    const dds_return_t count =
        dds_take(reader_.get(), samples_.data(), infos_.data(), samples_.size(),
                 static_cast<std::uint32_t>(samples_.size()));
    if (count <= 0) return 0;
    const Loan loan{reader_.get(), samples_.data(), count};
    keys_.make_room(reader_.get());
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      on_sample(*static_cast<const T*>(samples_[i]), info_of(infos_[i]));
    return count;
  }

  /// Same for those who only want values: `on_sample(const T&)`.
  template <class Callback>
  int take(Callback&& on_sample) {
    return take_with_info([&](const T& sample, const SampleInfo& info) {
      if (info.valid) on_sample(sample);
    });
  }

  [[nodiscard]] int matched_writers() const {
    dds_subscription_matched_status_t status{};
    check(dds_get_subscription_matched_status(reader_.get(), &status), "matched writers");
    return static_cast<int>(status.current_count);
  }

  /// For a WaitSet: true as long as there is something to take.
  [[nodiscard]] dds_entity_t readable() const { return readable_.get(); }
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  struct Loan {
    dds_entity_t reader;
    void** samples;
    dds_return_t count;
    ~Loan() { dds_return_loan(reader, samples, count); }
  };

  KeyLimit keys_;
  Entity topic_;
  Entity reader_;
  Entity readable_;
  std::vector<void*> samples_;
  std::vector<dds_sample_info_t> infos_;
};

}  // namespace mpm::idl
