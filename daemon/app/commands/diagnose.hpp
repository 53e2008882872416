#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm diagnose`: what the simulation gets wrong in recorded data, and a model that gets it right.
/// The exit code goes to `exit_code` once the command has run.
void add_diagnose(CLI::App& app, int& exit_code);

}  // namespace mpm::app
