#pragma once

#include <array>
#include <string>

#include "idl/entity.hpp"
#include "idl/participant.hpp"
#include "idl/qos.hpp"
#include "idl/topics.hpp"

namespace mpm::idl {

template <class T>
class Reader {
 public:
  /// Taken at once; also bounds how far one topic can run ahead of the others in a reading loop.
  static constexpr int kBatch = 64;

  Reader(const Participant& participant, const char* topic, const Qos& qos)
      : topic_(dds_create_topic(participant.get(), TopicType<T>::descriptor(), topic, nullptr,
                                nullptr),
               std::string("topic ") + topic),
        reader_(dds_create_reader(participant.get(), topic_.get(), qos.get(), nullptr),
                std::string("reader of ") + topic),
        readable_(dds_create_readcondition(reader_.get(), DDS_ANY_STATE), "read condition") {}

  /// Takes up to `kBatch` samples and calls `on_sample(const T&, const dds_sample_info_t&)` for
  /// each. Where `info.valid_data` is false only the keys are set: the instance changed its state.
  /// Within one instance the order is that of writing. Returns how many were taken.
  template <class Callback>
  int take_with_info(Callback&& on_sample) const {
    std::array<void*, kBatch> samples{};  // null: lend them, do not copy
    std::array<dds_sample_info_t, kBatch> infos;
    const dds_return_t count =
        dds_take(reader_.get(), samples.data(), infos.data(), kBatch, kBatch);
    if (count <= 0) return 0;
    const Loan loan{reader_.get(), samples.data(), count};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      on_sample(*static_cast<const T*>(samples[i]), infos[i]);
    return count;
  }

  /// Same for those who only want values: `on_sample(const T&)`.
  template <class Callback>
  int take(Callback&& on_sample) const {
    return take_with_info([&](const T& sample, const dds_sample_info_t& info) {
      if (info.valid_data) on_sample(sample);
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

  Entity topic_;
  Entity reader_;
  Entity readable_;
};

}  // namespace mpm::idl
