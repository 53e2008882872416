#pragma once

#include <cstdint>
#include <string>

#include "daemon/files/times/time_zone.hpp"

namespace mpm::report {

/// Whether a moment is one of a calendar, not of a run that began at 0: it lies after 1979.
[[nodiscard]] bool is_date(std::int64_t time_ns);

/// Moments of a recording as people say them: "14:20 on 3 March", and where its times are no dates
/// but seconds since some beginning, "4300 s".
class MomentText {
 public:
  /// `last_ns`: the end of the recording, whose year goes without saying. `zone`: null = UTC.
  /// Seconds of the day are told where samples are less than a minute apart.
  MomentText(std::int64_t last_ns, double sample_time_s, const files::TimeZone* zone);

  [[nodiscard]] std::string operator()(std::int64_t time_ns) const;
  [[nodiscard]] std::string with_year(std::int64_t time_ns) const;
  /// " (UTC)"; empty where there are no dates.
  [[nodiscard]] std::string zone() const;

 private:
  [[nodiscard]] std::string text(std::int64_t time_ns, bool year) const;
  [[nodiscard]] std::int64_t local_s(std::int64_t time_ns) const;

  bool dated_;
  bool seconds_;
  const files::TimeZone* zone_;
  std::string last_year_;
};

}  // namespace mpm::report
