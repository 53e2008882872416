#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm watch`: what the monitors say, live.
void add_watch(CLI::App& app, int& exit_code);

}  // namespace mpm::app
