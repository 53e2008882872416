#pragma once

#include <chrono>

#include "idl/entity.hpp"

namespace mpm::idl {

/// Sleeps until one of several readers, of any participants of this process, has something.
class WaitSet {
 public:
  WaitSet();

  /// `condition`: Reader::readable(); must outlive the wait set.
  void attach(dds_entity_t condition);
  /// True if something is there to take, false after `timeout`.
  [[nodiscard]] bool wait(std::chrono::nanoseconds timeout) const;

 private:
  Entity wait_set_;
};

}  // namespace mpm::idl
