#include "daemon/report/moment_text.hpp"

#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::report {
namespace {

// 1980: no plant has digital records from before it, and no run is 10 years long.
constexpr std::int64_t kFirstDateNs = 315'532'800 * kSecondNs;
constexpr double kMinute = 60.0;

}  // namespace

bool is_date(std::int64_t time_ns) { return time_ns >= kFirstDateNs; }

MomentText::MomentText(std::int64_t last_ns, double sample_time_s, const files::TimeZone* zone)
    : dated_(is_date(last_ns)),
      seconds_(sample_time_s < kMinute),
      zone_(zone),
      last_year_(files::formatted_utc(local_s(last_ns), "%Y")) {}

std::int64_t MomentText::local_s(std::int64_t time_ns) const {
  const std::int64_t utc_s = time_ns / kSecondNs;
  return zone_ == nullptr ? utc_s : utc_s + zone_->offset_s(utc_s);
}

std::string MomentText::text(std::int64_t time_ns, bool year) const {
  if (!dated_) return number_text(static_cast<double>(time_ns) / 1e9, 7) + " s";
  return files::formatted_utc(local_s(time_ns),
                              seconds_ ? "%H:%M:%S on %-d %B" : "%H:%M on %-d %B") +
         (year ? files::formatted_utc(local_s(time_ns), " %Y") : "");
}

std::string MomentText::operator()(std::int64_t time_ns) const {
  return text(time_ns, files::formatted_utc(local_s(time_ns), "%Y") != last_year_);
}

std::string MomentText::with_year(std::int64_t time_ns) const { return text(time_ns, true); }

std::string MomentText::zone() const {
  if (!dated_) return "";
  return " (" + (zone_ == nullptr ? std::string("UTC") : zone_->name()) + ")";
}

}  // namespace mpm::report
