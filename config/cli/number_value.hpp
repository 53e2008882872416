#pragma once

#include <CLI/CLI.hpp>
#include <limits>

namespace mpm::cli {

/// A number from `least` to `most`, and finite: CLI11's own checks let nan through, and tell a
/// range without an end in three hundred digits.
[[nodiscard]] CLI::Validator number_value(double least,
                                          double most = std::numeric_limits<double>::max());

}  // namespace mpm::cli
