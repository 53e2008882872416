#include "daemon/report/pulses_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/text/number_text.hpp"
#include "daemon/report/moment_text.hpp"

namespace mpm::report {
namespace {

constexpr std::size_t kNamed = 3;

std::int64_t time_ns(const Recording& recording, Eigen::Index row) {
  const double by_rows_s = recording.start_s + static_cast<double>(row) * recording.sample_time_s;
  return std::llround(on_clock(recording, by_rows_s) * 1e9);
}

}  // namespace

std::string pulses_text(const config::UnitConfig& unit, const Recording& recording,
                        const std::vector<Pulse>& pulses, const files::TimeZone* zone) {
  if (pulses.empty()) return {};
  const MomentText moment(time_ns(recording, recording.samples() - 1), recording.sample_time_s,
                          zone);
  std::string text = "no CV answers ";
  for (std::size_t p = 0; p < std::min(pulses.size(), kNamed); ++p) {
    const Pulse& pulse = pulses[p];
    text += (p > 0 ? ", " : "") + unit.input_tag(pulse.input) + " going from " +
            number_text(pulse.before) + " to " + number_text(pulse.value) + " and back at " +
            moment(time_ns(recording, pulse.row));
  }
  if (pulses.size() > kNamed)
    text += " and " + std::to_string(pulses.size() - kNamed) + " more such jumps";
  return text + ": " + (pulses.size() == 1 ? "it is" : "they are") + " taken as not known there";
}

}  // namespace mpm::report
