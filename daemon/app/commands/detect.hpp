#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm detect`: the daemon's own pipeline on a file.
void add_detect(CLI::App& app, int& exit_code);

}  // namespace mpm::app
