#include "daemon/app/commands/domain_flags.hpp"

namespace mpm::app {

void add_domain_flags(CLI::App& command, idl::DomainOptions& domain) {
  command.add_option("--domain", domain.domain, "DDS domain")
      ->capture_default_str()
      ->check(CLI::Range(0, 230));
  command.add_option("--partition", domain.partition, "discovery tag");
  command.add_option("--interface", domain.interface, "network interface")->capture_default_str();
  command.add_option("--peer", domain.peers, "host to look for others on; repeatable")
      ->allow_extra_args(false);  // what follows may be a file or a topic
  command.add_flag("--multicast", domain.multicast, "look for others by multicast");
  command.add_flag("--dds-from-environment", domain.use_environment,
                   "take the DDS settings from CYCLONEDDS_URI");
}

idl::DomainOptions with_flags(const CLI::App& command, idl::DomainOptions settings,
                              const idl::DomainOptions& flags) {
  const auto given = [&](const char* name) { return command.get_option(name)->count() > 0; };
  if (given("--domain")) settings.domain = flags.domain;
  if (given("--partition")) settings.partition = flags.partition;
  if (given("--interface")) settings.interface = flags.interface;
  if (given("--peer")) settings.peers = flags.peers;
  if (given("--multicast")) settings.multicast = flags.multicast;
  settings.use_environment = flags.use_environment;
  return settings;
}

}  // namespace mpm::app
