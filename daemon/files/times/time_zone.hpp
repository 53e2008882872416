#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace mpm::files {

/// A zone of the time zone database, e.g. Europe/Berlin. It sets the process's own zone: for
/// programs of one thread, or of one zone that is made before the other threads.
class TimeZone {
 public:
  /// Throws config::InputError (naming the zone) where the database does not have it.
  explicit TimeZone(const std::string& name);

  /// The moments that a local time may mean: none while the clock goes forward over it, two in the
  /// hour that it shows twice, the earlier one first.
  struct Moments {
    int count = 0;
    std::array<std::int64_t, 2> utc_s{};  ///< since 1970
  };
  /// `local_s`: what the clock shows, counted as if it were UTC.
  [[nodiscard]] Moments moments(std::int64_t local_s) const;
  /// Seconds east of UTC at that moment.
  [[nodiscard]] int offset_s(std::int64_t utc_s) const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace mpm::files
