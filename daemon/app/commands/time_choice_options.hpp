#pragma once

#include <CLI/CLI.hpp>

#include "daemon/files/times/time_choice.hpp"

namespace mpm::app {

/// Adds --from, --until and --exclude.
void add_time_choice(CLI::App& command, files::TimeChoiceText& text);

}  // namespace mpm::app
