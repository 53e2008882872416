#pragma once

namespace CLI {
class App;
}

namespace mpm::cli {

/// Has all whole numbers that `app` and its commands take read as decimals, whatever zeros they
/// begin with: CLI11 takes such a one for octal. What their 64 bits do not hold is refused: CLI11
/// takes the end of them, and for -1 the upper one. After all options are declared.
void read_decimals(CLI::App& app);

}  // namespace mpm::cli
