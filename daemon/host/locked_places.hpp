#pragma once

#include <set>
#include <string>
#include <vector>

#include "daemon/host/lock_file.hpp"

namespace mpm::host {

/// The lock files of all places that a process writes to. A place that is removed while it is held,
/// as a folder by who tidies up, would be made anew by whoever writes next, without its lock: a
/// second process would be let in. So the place is made and locked anew at once.
class LockedPlaces {
 public:
  /// `files`: the lock files. Throws as LockFile does.
  explicit LockedPlaces(const std::set<std::string>& files);
  /// What could not be locked, and why.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// Now and then: locks anew what was removed. Returns what is to be said of it, once each. Throws
  /// std::runtime_error where another process was quicker, beside which this one may not write.
  [[nodiscard]] std::vector<std::string> look();

 private:
  struct Place {
    LockFile lock;
    bool lost = false;  // and that was said
  };
  std::vector<Place> places_;
};

}  // namespace mpm::host
