#pragma once

#include "config/unit_config.hpp"
#include "idl/participant.hpp"

namespace mpm::bus {

/// The DDS side of a unit file, which idl knows nothing of, for one who has that role.
[[nodiscard]] inline idl::DomainOptions domain_options(const config::DdsSettings& settings,
                                                       const std::string& role) {
  idl::DomainOptions options;
  options.role = role;
  options.domain = settings.domain;
  options.interface = settings.interface;
  options.peers = settings.peers;
  options.multicast = settings.multicast;
  options.partition = settings.partition;
  options.max_participants = settings.max_participants;
  options.security = settings.security;
  return options;
}

}  // namespace mpm::bus
