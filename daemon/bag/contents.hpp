#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/signal/frame.hpp"

namespace mpm::bag {

/// One kind of signals of a unit, as a recording knows it.
struct RecordedKind {
  bool seen = false;                           ///< there are samples
  int width = 0;                               ///< values of the first sample
  std::vector<std::string> tags;               ///< from the last layout; empty where there is none
  std::vector<std::string> engineering_units;  ///< as many, or fewer
};

/// Of one recording: more is no recording but something that fills memory.
inline constexpr std::size_t kMostUnits = 10'000;

struct RecordedUnit {
  std::array<RecordedKind, kSignalKindCount> kinds;
  double sample_time_s = 0.0;  ///< of the layout; 0 = not known

  [[nodiscard]] RecordedKind& operator[](SignalKind kind) {
    return kinds[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const RecordedKind& operator[](SignalKind kind) const {
    return kinds[static_cast<std::size_t>(kind)];
  }
};

/// By name.
using Contents = std::map<std::string, RecordedUnit, std::less<>>;

/// What units MCAP files hold. Reads on until `enough(contents)` or the end. Throws
/// config::InputError where the file cannot be read.
[[nodiscard]] Contents contents_of(const std::vector<std::string>& paths,
                                   const std::function<bool(const Contents&)>& enough);

/// "'a', 'b'", for messages.
[[nodiscard]] std::string names_of(const Contents& contents);

}  // namespace mpm::bag
