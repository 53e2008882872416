#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "idl/discovery.hpp"
#include "idl/entity.hpp"
#include "idl/key_limit.hpp"
#include "idl/participant.hpp"
#include "idl/raw_sample.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::idl {

/// Reads one topic without looking into its samples.
class RawReader {
 public:
  /// `units`: as for a Reader.
  RawReader(const Participant& participant, const KnownTopic& topic, UnitChoice* units = nullptr);
  /// A topic that is not ours. `type` needs to live during the call only.
  RawReader(const Participant& participant, const std::string& topic, const DiscoveredType& type);

  /// Takes one batch and calls `on_sample` for each sample, which may be moved from. Samples come
  /// instance by instance, within one in the order of writing. Returns how many were taken.
  int take(const std::function<void(RawSample&)>& on_sample);

  /// Samples of instances too many, or with names too long, since the last call.
  [[nodiscard]] KeyLimit::Refused refused() { return keys_->refused(); }
  /// Samples that Cyclone says it lost on the way, since the start.
  [[nodiscard]] std::uint64_t lost() const;
  [[nodiscard]] int matched_writers() const;
  /// For a WaitSet: true as long as there is something to take.
  [[nodiscard]] dds_entity_t readable() const { return readable_.get(); }
  [[nodiscard]] const std::string& topic() const { return name_; }
  [[nodiscard]] const std::string& type_name() const { return type_name_; }

 private:
  RawReader(const Participant& participant, const std::string& topic,
            const dds_topic_descriptor_t& type, const Qos& qos, std::size_t names,
            UnitChoice* units);

  std::string name_, type_name_;
  std::unique_ptr<KeyLimit> keys_;
  Entity topic_;
  Entity reader_;
  Entity readable_;
  RawSample sample_;
};

}  // namespace mpm::idl
