#pragma once

#include <dds/dds.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace mpm::idl {

/// DDS refused: thrown while setting up only.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Passes entity handles and counts through, throws `Error` on a negative return code. The reason
/// for a refused configuration is only in Cyclone's log, so its last line is part of the message.
dds_return_t check(dds_return_t code, const std::string& what);

/// Owns one DDS entity (and with it its children).
class Entity {
 public:
  Entity() = default;
  Entity(dds_return_t handle, const std::string& what) : handle_(check(handle, what)) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  // A parent that went first took this one along; the error of the second delete is harmless.
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }

  [[nodiscard]] dds_entity_t get() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

}  // namespace mpm::idl
