#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

/// What numbers of the command line may look like. Each makes of its text the plain number.
namespace mpm::app {

/// A time in seconds, or with a unit: 90, 1.5h, 5min. Becomes seconds.
[[nodiscard]] CLI::Validator time_value();
/// The same, but not 0.
[[nodiscard]] CLI::Validator positive_time_value();
/// A size in bytes, or with a unit: 100MB, 1.5GB, 4KiB; kB = 1000. Becomes bytes, `smallest` or
/// more.
[[nodiscard]] CLI::Validator size_value(std::uint64_t smallest);

}  // namespace mpm::app
