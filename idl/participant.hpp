#pragma once

#include <string>
#include <vector>

#include "idl/entity.hpp"

namespace mpm::idl {

/// Where on the network to meet the others.
struct DomainOptions {
  int domain = 0;                  ///< 0..230; above 100 ports collide with ephemeral ones
  std::string interface = "lo";    ///< by name; empty = Cyclone's choice
  std::vector<std::string> peers;  ///< host addresses beside this host
  bool multicast = false;          ///< find others by multicast as well
  std::string partition;           ///< discovery tag: only equal tags see each other
  int max_participants = 60;       ///< processes of this domain on one host
  /// A lossless writer waits for its readers above this. Small, so that no topic of a unit gets far
  /// ahead of the others. Writers that keep only the last samples never wait.
  int max_unacknowledged_kb = 32;
  /// Larger samples are dropped, whether read or written; 0 = no limit of ours.
  int max_sample_kb = 0;
  bool use_environment = false;  ///< CYCLONEDDS_URI, where set, overrides all but the domain
  /// Folder of keys (`mpm keys`), with one folder for each role; empty: whoever is there takes
  /// part.
  std::string security;
  std::string role = "viewer";  ///< whose keys this participant has
};

/// CYCLONEDDS_URI is set, and a participant with these options does not look at it.
[[nodiscard]] bool ignores_environment(const DomainOptions& options);

/// The configuration that `options` stand for, as Cyclone reads it.
[[nodiscard]] std::string domain_xml(const DomainOptions& options);

/// One presence on one DDS domain. Each has a Cyclone domain of its own (threads and sockets), so
/// several with different options live in one process and meet over the network like strangers.
class Participant {
 public:
  explicit Participant(const DomainOptions& options);

  [[nodiscard]] dds_entity_t get() const { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

}  // namespace mpm::idl
