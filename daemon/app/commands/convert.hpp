#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm convert`: recordings and data files into each other.
void add_convert(CLI::App& app, int& exit_code);

}  // namespace mpm::app
