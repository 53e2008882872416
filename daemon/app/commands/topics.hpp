#pragma once

#include <CLI/CLI.hpp>

namespace mpm::app {

/// `mpm topics`: who reads and writes what on the bus.
void add_topics(CLI::App& app, int& exit_code);
/// `mpm echo`: the samples of a topic as text.
void add_echo(CLI::App& app, int& exit_code);
/// `mpm hz` and `mpm delay`: how often samples come, and how old they are.
void add_hz(CLI::App& app, int& exit_code);
void add_delay(CLI::App& app, int& exit_code);

}  // namespace mpm::app
