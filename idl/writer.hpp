#pragma once

#include <cstdint>
#include <string>

#include "idl/entity.hpp"
#include "idl/participant.hpp"
#include "idl/qos.hpp"
#include "idl/topics.hpp"

namespace mpm::idl {

template <class T>
class Writer {
 public:
  Writer(const Participant& participant, const char* topic, const Qos& qos)
      : topic_(dds_create_topic(participant.get(), TopicType<T>::descriptor(), topic, nullptr,
                                nullptr),
               std::string("topic ") + topic),
        writer_(dds_create_writer(participant.get(), topic_.get(), qos.get(), nullptr),
                std::string("writer of ") + topic) {}

  /// False if the sample could not be handed over, e.g. because readers did not follow in time.
  [[nodiscard]] bool write(const T& sample) const {
    return dds_write(writer_.get(), &sample) == DDS_RETCODE_OK;
  }

  [[nodiscard]] int matched_readers() const {
    dds_publication_matched_status_t status{};
    check(dds_get_publication_matched_status(writer_.get(), &status), "matched readers");
    return static_cast<int>(status.current_count);
  }

  /// As SampleInfo::writer of what it writes.
  [[nodiscard]] std::uint64_t handle() const {
    dds_instance_handle_t handle = 0;
    check(dds_get_instance_handle(writer_.get(), &handle), "handle of a writer");
    return handle;
  }

  [[nodiscard]] dds_entity_t get() const { return writer_.get(); }

 private:
  Entity topic_;
  Entity writer_;
};

}  // namespace mpm::idl
