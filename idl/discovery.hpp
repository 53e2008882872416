#pragma once

#include <memory>
#include <string>
#include <vector>

#include "idl/participant.hpp"

namespace mpm::idl {

/// Somebody's reader or writer on the bus.
struct Endpoint {
  std::string topic;
  std::string type;
  bool writer = false;
};

/// A type that was asked of the one who uses it.
struct DescriptorDeleter {
  void operator()(dds_topic_descriptor_t* type) const { dds_delete_topic_descriptor(type); }
};
using DiscoveredType = std::unique_ptr<dds_topic_descriptor_t, DescriptorDeleter>;

/// Who else is on the bus. Others are found within a second or so of the participant's start.
class Discovery {
 public:
  explicit Discovery(const Participant& participant);

  /// All endpoints of others that are known by now and still there, by topic.
  [[nodiscard]] std::vector<Endpoint> endpoints() const;
  /// The type of `topic` as one of its writers describes it (XTypes); null if none does, or in a
  /// way that Cyclone 0.10 cannot use. May take up to a second.
  [[nodiscard]] DiscoveredType type_of(const std::string& topic) const;

 private:
  void add(const Entity& reader, bool writers, std::vector<Endpoint>& endpoints) const;

  dds_entity_t participant_;
  Entity publications_;
  Entity subscriptions_;
};

}  // namespace mpm::idl
