#include "daemon/bag/replay/selection.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <set>
#include <stdexcept>

#include "core/text/printable.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::bag {
namespace {

using Units = std::set<std::string>;

constexpr double kNsPerSecond = 1e9;

[[noreturn]] void fail(const std::string& message) { throw std::invalid_argument(message); }

std::string without(const std::string& unit, const Units& units) {
  std::string text = "the recording has no unit '" + unit + "', but ";
  for (const std::string& other : units)
    text += (&other == &*units.begin() ? "" : ", ") + printable(other);
  return text;
}

std::string seconds_text(std::int64_t time_ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", static_cast<double>(time_ns) / kNsPerSecond);
  return text.data();
}

}  // namespace

bool is_over(const PlayerOptions& options, std::int64_t begin_ns, std::int64_t log_time_ns) {
  const std::int64_t since_ns = log_time_ns - begin_ns;
  return (options.duration_ns > 0 && since_ns - options.start_offset_ns >= options.duration_ns) ||
         (options.end_offset_ns > 0 && since_ns >= options.end_offset_ns) ||
         (options.end_ns && log_time_ns >= *options.end_ns);
}

bool selects(const PlayerOptions& options, std::int64_t begin_ns, std::int64_t log_time_ns,
             const std::string& unit) {
  return log_time_ns - begin_ns >= options.start_offset_ns &&
         !is_over(options, begin_ns, log_time_ns) && (options.unit.empty() || unit == options.unit);
}

void check_selection(ReplaySource& source, const PlayerOptions& options) {
  Units units;
  std::optional<std::int64_t> begin_ns;
  std::int64_t length_ns = 0;
  bool any = false;
  const auto is_there = [&](const auto& rule) { return units.count(rule.first) > 0; };
  const auto all_there = [&] {
    return std::all_of(options.remap.begin(), options.remap.end(), is_there);
  };
  ReplaySample sample;
  while (!(any && all_there()) && source.next(sample)) {
    if (!begin_ns) begin_ns = sample.log_time_ns;
    length_ns = sample.log_time_ns - *begin_ns;
    const std::string unit = idl::unit_of(sample.cdr);
    units.insert(unit);
    any = any || selects(options, *begin_ns, sample.log_time_ns, unit);
  }
  source.rewind();
  if (!begin_ns) fail("the recording holds no sample of the topics to replay");
  if (!options.unit.empty() && !any && units.count(options.unit) == 0)
    fail("--unit: " + without(options.unit, units));
  for (const auto& [from, to] : options.remap)
    if (units.count(from) == 0) fail("--remap: " + without(from, units));
  if (any) return;
  if (options.start_offset_ns > length_ns)
    fail("--start-offset: the recording ends after " + seconds_text(length_ns));
  if (options.end_ns && *options.end_ns <= *begin_ns)
    fail("--playback-until: the recording begins at " + files::utc_text(*begin_ns));
  fail("no sample lies in the part that --start-offset, --duration and --playback-until choose");
}

}  // namespace mpm::bag
