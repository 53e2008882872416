#pragma once

#include <cstddef>

namespace mpm::calibration::archive {

/// Bytes that are copied before it is asked whether to stop. Chosen: a tenth of a millisecond or
/// two (tests/bench/bench_archive.cpp).
inline constexpr std::size_t kPiece = std::size_t{1} << 20U;

}  // namespace mpm::calibration::archive
