#pragma once

#include <CLI/CLI.hpp>

namespace mpm::daemon {

/// `mpm info`: what a data file holds.
void add_info(CLI::App& app, int& exit_code);

}  // namespace mpm::daemon
