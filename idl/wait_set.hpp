#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "idl/entity.hpp"

namespace mpm::idl {

/// Sleeps until one of several readers, of any participants of this process, has something. How
/// long it sleeps is reckoned on the steady clock: in Cyclone's own wait sets (0.10) a machine's
/// clock that is set back by an hour meanwhile makes the wait an hour longer.
class WaitSet {
 public:
  WaitSet();
  WaitSet(const WaitSet&) = delete;
  WaitSet& operator=(const WaitSet&) = delete;
  ~WaitSet();

  /// `condition`: Reader::readable(); must outlive the wait set. A reader belongs to one wait set.
  void attach(dds_entity_t condition);
  /// True if something is there to take, false after `timeout`.
  [[nodiscard]] bool wait(std::chrono::nanoseconds timeout) const;

 private:
  struct Bell;

  [[nodiscard]] bool anything() const;

  std::unique_ptr<Bell> bell_;
  std::vector<dds_entity_t> conditions_, readers_;
};

}  // namespace mpm::idl
