#pragma once

#include <CLI/CLI.hpp>

#include "idl/participant.hpp"

namespace mpm::app {

/// The options of every command that needs no unit file to find the bus.
void add_domain_flags(CLI::App& command, idl::DomainOptions& domain);

/// `settings`, but for what of `flags` was given on the command line of `command`, which has
/// add_domain_flags' options.
[[nodiscard]] idl::DomainOptions with_flags(const CLI::App& command, idl::DomainOptions settings,
                                            const idl::DomainOptions& flags);

}  // namespace mpm::app
