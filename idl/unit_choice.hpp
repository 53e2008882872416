#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel/mutex.hpp"

namespace mpm::idl {

/// The units of which a reader takes samples. What others write is counted and gone before it is
/// kept: Cyclone would keep an instance of each name that anybody makes up. Asked by Cyclone's
/// threads, hence locked.
class UnitChoice {
 public:
  /// What was not taken.
  struct Refused {
    std::uint64_t samples = 0;
    /// Printable, the first few; each with a writer of it, as in SampleInfo.
    std::map<std::string, std::uint64_t> units;
  };

  explicit UnitChoice(const std::vector<std::string>& units) : units_(units.begin(), units.end()) {}
  /// False, and remembered, where the unit is none of these.
  [[nodiscard]] bool takes(std::string_view unit, std::uint64_t writer);
  /// What was refused since the last call.
  [[nodiscard]] Refused refused();

 private:
  const std::set<std::string, std::less<>> units_;
  Mutex mutex_;
  Refused refused_ MPM_GUARDED_BY(mutex_);
};

}  // namespace mpm::idl
