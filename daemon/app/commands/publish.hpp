#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm publish`: lines on standard input become a unit's samples on DDS.
void add_publish(CLI::App& app, int& exit_code);

}  // namespace mpm::app
