#include "daemon/app/commands/domain_flags.hpp"

#include <iostream>
#include <string>
#include <utility>

#include "config/load_unit.hpp"
#include "daemon/bus/domain_options.hpp"

namespace mpm::app {

CLI::Option* add_domain_flags(CLI::App& command, idl::DomainOptions& domain, OnUnit on_unit) {
  // The first that is added is the first that takes effect: the others overrule it.
  const auto take_unit = [&domain, on_unit = std::move(on_unit)](const std::string& file) {
    const config::LoadResult loaded = config::load_unit(file);
    for (const config::Finding& finding : loaded.findings)
      std::cerr << config::format(finding) << '\n';
    if (!loaded.ok()) throw CLI::ValidationError("--config", file + " is no good unit file");
    domain = bus::domain_options(loaded.config.dds, domain.role);
    if (on_unit) on_unit(loaded.config);
  };
  CLI::Option* config = command.add_option_function<std::string>(
      "-c,--config", take_unit,
      "unit file whose DDS settings are taken, but for those that are given here");
  add_bus_flags(command, domain);
  command.parse_complete_callback([&domain] { warn_of_environment(domain); });
  return config;
}

void warn_of_environment(const idl::DomainOptions& domain) {
  if (idl::ignores_environment(domain))
    std::cerr << "mpm: CYCLONEDDS_URI is set, but not used; --dds-from-environment takes it\n";
}

void add_bus_flags(CLI::App& command, idl::DomainOptions& domain) {
  command.add_option("--domain", domain.domain, "DDS domain")
      ->capture_default_str()
      ->check(CLI::Range(0, config::kHighestDomain));
  command.add_option("--partition", domain.partition, "discovery tag");
  command.add_option("--interface", domain.interface, "network interface")->capture_default_str();
  command.add_option("--peer", domain.peers, "host to look for others on; repeatable")
      ->allow_extra_args(false);  // what follows may be a file or a topic
  command.add_flag("--multicast", domain.multicast, "look for others by multicast");
  command.add_option("--security", domain.security,
                     "folder of keys, as `mpm keys` makes; taken are those of the " + domain.role);
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
  if (given("--security")) settings.security = flags.security;
  settings.use_environment = flags.use_environment;
  return settings;
}

}  // namespace mpm::app
