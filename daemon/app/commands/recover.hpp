#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm recover`: mends a recording whose recorder was killed.
void add_recover(CLI::App& app, int& exit_code);

}  // namespace mpm::app
