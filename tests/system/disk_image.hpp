#pragma once

#include <random>
#include <string>

namespace mpm::test {

/// What a power cut may leave of a folder that a program wrote under preload/power_cut.
enum class Cut {
  kNothingMore,  ///< what was synced, and nothing that was not
  kTorn,         ///< of all that was not synced some: pages of 4096 bytes, lengths, names
};

/// Puts into `image`, which must not be there, what is left of `folder` with what the program kept
/// in `disk`. A page whose place was never written is zeros.
void cut_power(const std::string& folder, const std::string& disk, const std::string& image,
               Cut cut, std::mt19937_64& random);

}  // namespace mpm::test
