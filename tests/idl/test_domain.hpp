#pragma once

#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "idl/participant.hpp"

namespace mpm::idl {

/// Options of a domain that no other test sees, on loopback.
inline DomainOptions test_domain(const std::string& test) {
  DomainOptions options;
  options.domain = 7;
  options.partition = test + "-" + std::to_string(getpid());
  return options;
}

/// Polls `done` until it is true; false after `timeout`.
template <class Condition>
[[nodiscard]] bool eventually(Condition&& done,
                              std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  timeout *= 4;  // how long a thing takes is not what a sanitizer is asked
#endif
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!done()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace mpm::idl
