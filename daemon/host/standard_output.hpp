#pragma once

namespace mpm::host {

/// Standard output is a pipe that nobody will ever read.
[[nodiscard]] bool reader_has_left();
/// Writes out what standard output still holds. False if anything was lost although somebody reads;
/// that a reader has left its pipe is no failure.
[[nodiscard]] bool finish_standard_output();

}  // namespace mpm::host
