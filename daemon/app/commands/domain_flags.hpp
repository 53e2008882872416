#pragma once

#include <CLI/CLI.hpp>

#include "idl/participant.hpp"

namespace mpm::app {

/// The options of every command that needs no unit file to find the bus.
void add_domain_flags(CLI::App& command, idl::DomainOptions& domain);

}  // namespace mpm::app
