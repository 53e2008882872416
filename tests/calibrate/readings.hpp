#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// What the mismatch test says of healthy channels on simulated closed loops, before anything asks
/// whether it may speak yet.
namespace mpm::calibrate {

/// Memories of these many rows per column are read; the fewest with which a residual variance means
/// anything, up to well beyond what is asked for.
inline constexpr int kRowsPerColumn[] = {3, 4, 5, 6, 8, 10, 15, 20, 25, 30};

/// One test of one channel, as F without the factor for few rows.
struct Reading {
  int rows_per_column = 0;
  double directed = 0.0;     ///< of the usual errors; only where directed_freedom > 0
  int directed_freedom = 0;  ///< of its numerator
  double block = 0.0;        ///< of the whole block
  int block_freedom = 0;     ///< of its numerator
  double columns_per_freedom = 0.0;
  double freedom = 0.0;  ///< of both denominators
};

/// One seed of one plant. Readings of one run depend on each other, runs do not.
struct Run {
  std::string plant;
  std::vector<Reading> readings;
  std::vector<double> clipped_shares;  ///< per CV, after the most rows
};

/// What is run: nothing is wrong in any of it.
struct Loops {
  std::vector<std::string> plants;  ///< files in config/plants
  std::string scenario;             ///< file in config/scenarios
  std::uint64_t first_seed = 100001;
  int seeds = 0;  ///< per plant
  int threads = 1;
};

/// In the order of plants and seeds, whatever the threads. Throws std::runtime_error where a file
/// cannot be read or a loop diverges.
[[nodiscard]] std::vector<Run> read_loops(const Loops& loops);

}  // namespace mpm::calibrate
