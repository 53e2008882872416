#pragma once

#include <chrono>
#include <map>
#include <string>

namespace mpm::bus {

/// Of several monitors that publish for one unit, the one to listen to: who spoke first, until it
/// leaves or falls silent. What two say in turn would be a picture of neither.
class Speakers {
 public:
  using Clock = std::chrono::steady_clock;

  /// True where `name`, the process of a monitor, is the one.
  [[nodiscard]] bool listens_to(const std::string& unit, const std::string& name,
                                Clock::time_point now);
  /// Whom it listens to; empty where nobody spoke.
  [[nodiscard]] std::string first(const std::string& unit) const;
  /// The monitor of `unit` with this name left.
  void leaves(const std::string& unit, const std::string& name);
  /// "two monitors publish ..., shown is the first", or that of more; empty where one does.
  [[nodiscard]] std::string note(const std::string& unit, Clock::time_point now) const;

 private:
  struct Unit {
    std::string first;
    std::map<std::string, Clock::time_point> heard;  // by name
  };
  std::map<std::string, Unit> units_;
};

}  // namespace mpm::bus
