#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "idl/participant.hpp"

namespace mpm::idl {

/// Who reads or writes, as Cyclone says it of itself; other makes may leave all of it empty.
struct Process {
  std::string host;
  std::string program;
  std::string pid;
};
/// "mpmd (process 4711 on host plant1)", or "a process that does not give its name".
[[nodiscard]] std::string name_of(const Process& process);

/// Somebody's reader or writer on the bus.
struct Endpoint {
  std::string topic;
  std::string type;
  bool writer = false;
  std::uint64_t handle = 0;  ///< a writer's: as in SampleInfo
  Process process;
  /// Of a topic of ours: why it meets no reader (of an output: no writer) that has the topic's
  /// profile, each reason in words. Empty where it does.
  std::vector<std::string> mismatch;
  std::string user_data = {};  ///< whatever it gives
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
  /// This process, as others see it.
  [[nodiscard]] Process own() const;
  /// The type of `topic` as one of its writers describes it (XTypes); null if none does, or in a
  /// way that Cyclone 0.10 cannot use. May take up to a second.
  [[nodiscard]] DiscoveredType type_of(const std::string& topic) const;

 private:
  dds_entity_t participant_;
  Entity participants_;
  Entity publications_;
  Entity subscriptions_;
};

}  // namespace mpm::idl
