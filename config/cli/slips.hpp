#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace mpm::cli {

/// After a command line that could not be parsed: a line for each of its words that is no command
/// or no option, with what was likely meant; empty where it is wrong otherwise.
[[nodiscard]] std::string slips_text(const CLI::App& app);

}  // namespace mpm::cli
