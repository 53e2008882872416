#pragma once

#include <functional>
#include <string>
#include <vector>

#include "idl/entity.hpp"
#include "idl/participant.hpp"
#include "idl/qos.hpp"
#include "idl/raw_sample.hpp"

namespace mpm::idl {

/// Reads one topic without looking into its samples.
class RawReader {
 public:
  /// `type` needs to live during the call only.
  RawReader(const Participant& participant, const std::string& topic,
            const dds_topic_descriptor_t& type, const Qos& qos);

  /// Takes one batch and calls `on_sample` for each sample, which may be moved from. Samples come
  /// instance by instance, within one in the order of writing. Returns how many were taken.
  int take(const std::function<void(RawSample&)>& on_sample);

  /// Samples that Cyclone says it lost on the way, since the start.
  [[nodiscard]] std::uint64_t lost() const;
  [[nodiscard]] int matched_writers() const;
  /// For a WaitSet: true as long as there is something to take.
  [[nodiscard]] dds_entity_t readable() const { return readable_.get(); }
  [[nodiscard]] const std::string& topic() const { return name_; }

 private:
  std::string name_;
  Entity topic_;
  Entity reader_;
  Entity readable_;
  RawSample sample_;
};

}  // namespace mpm::idl
