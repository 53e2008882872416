#pragma once

#include <dds/dds.h>

#include <stdexcept>
#include <string>
#include <utility>

/// A participant, topic, reader or writer, deleted where it goes out of scope.
class Entity {
 public:
  Entity(dds_entity_t handle, const std::string& what) : handle_(handle) {
    if (handle < 0) throw std::runtime_error(what + ": " + dds_strretcode(handle));
  }
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }
  [[nodiscard]] dds_entity_t get() const { return handle_; }

 private:
  dds_entity_t handle_;
};
