#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm replay`: recordings back onto the bus.
void add_replay(CLI::App& app, int& exit_code);

}  // namespace mpm::app
