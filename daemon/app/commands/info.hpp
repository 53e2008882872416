#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm info`: what a data file holds.
void add_info(CLI::App& app, int& exit_code);

}  // namespace mpm::app
