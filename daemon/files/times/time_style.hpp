#pragma once

#include <memory>
#include <utility>

#include "daemon/files/times/time_format.hpp"
#include "daemon/files/times/time_zone.hpp"

namespace mpm::files {

/// What the user says about the times of a file.
struct TimeStyle {
  TimeStyle() = default;
  TimeStyle(std::shared_ptr<const TimeZone> its_zone,  // NOLINT(google-explicit-constructor)
            std::shared_ptr<const TimeFormat> its_format = nullptr)
      : zone(std::move(its_zone)), format(std::move(its_format)) {}
  TimeStyle(std::nullptr_t) {}  // NOLINT(google-explicit-constructor)

  std::shared_ptr<const TimeZone> zone;      ///< of local times; null = they are refused
  std::shared_ptr<const TimeFormat> format;  ///< of all times; null = found
};

}  // namespace mpm::files
