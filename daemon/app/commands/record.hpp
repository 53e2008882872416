#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm record`: what goes over the bus, into files.
void add_record(CLI::App& app, int& exit_code);

}  // namespace mpm::app
