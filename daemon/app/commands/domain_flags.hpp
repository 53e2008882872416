#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "config/unit_config.hpp"
#include "idl/participant.hpp"

namespace mpm::app {

/// Says so on standard error where CYCLONEDDS_URI is set and not used.
void warn_of_environment(const idl::DomainOptions& domain);

using OnUnit = std::function<void(const config::UnitConfig&)>;

/// The options of every command that needs no unit file to find the bus; one that is given with
/// --config says where to, in so far as no other option does, and is passed to `on_unit`. Returns
/// that option.
CLI::Option* add_domain_flags(CLI::App& command, idl::DomainOptions& domain, OnUnit on_unit = {});

/// The same without --config, for commands that have one of their own.
void add_bus_flags(CLI::App& command, idl::DomainOptions& domain);

/// `settings`, but for what of `flags` was given on the command line of `command`, which has these
/// options.
[[nodiscard]] idl::DomainOptions with_flags(const CLI::App& command, idl::DomainOptions settings,
                                            const idl::DomainOptions& flags);

}  // namespace mpm::app
