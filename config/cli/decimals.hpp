#pragma once

namespace CLI {
class App;
}

namespace mpm::cli {

/// Has all whole numbers that `app` and its commands take read as decimals, whatever zeros they
/// begin with: CLI11 takes such a one for octal. After all options are declared.
void read_decimals(CLI::App& app);

}  // namespace mpm::cli
