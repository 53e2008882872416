#include "daemon/app/commands/find_other_row.hpp"

#include <memory>

#include "daemon/bag/open_recording.hpp"
#include "daemon/files/shifted_cvs.hpp"
#include "daemon/report/detect_report.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::app {
namespace {

using Way = files::ShiftedCvs::Way;

/// What the monitor says of all that is taken; at once where `enough` says so.
template <class Enough>
std::vector<ChannelRecord> watch(const config::UnitConfig& unit, files::FrameSource& source,
                                 const files::TimeChoice& choice, const Enough& enough) {
  report::UnitMonitor monitor(unit);
  Frame frame(unit.counts());
  while (source.next(frame)) {
    if (!choice.takes(frame.source_time_ns)) continue;
    monitor.push(frame);
    if (enough(monitor)) break;
  }
  return monitor.channels();
}

}  // namespace

report::OtherRow find_other_row(const config::UnitConfig& unit,
                                const std::vector<std::string>& files,
                                const files::TimeStyle& times, const files::TimeChoice& choice) {
  for (const Way way : {Way::kEarlier, Way::kLater}) {
    const std::unique_ptr<files::FrameSource> frames = bag::open_recording(files, unit, times);
    files::ShiftedCvs shifted(*frames, unit.counts(), way);
    bool alarms = false;
    const std::vector<ChannelRecord> channels = watch(
        unit, shifted, choice,
        [&](const report::UnitMonitor& monitor) { return alarms = !monitor.alarms().empty(); });
    if (!alarms && report::all_match(channels))
      return way == Way::kEarlier ? report::OtherRow::kEarlier : report::OtherRow::kLater;
  }
  return report::OtherRow::kNone;
}

report::OtherRow find_other_row_if_wrong(const config::UnitConfig& unit,
                                         const std::vector<std::string>& files,
                                         const files::TimeStyle& times,
                                         const files::TimeChoice& choice) {
  const std::unique_ptr<files::FrameSource> frames = bag::open_recording(files, unit, times);
  const auto all = [](const report::UnitMonitor&) { return false; };
  return report::mismatching_cvs(watch(unit, *frames, choice, all)) > 1
             ? find_other_row(unit, files, times, choice)
             : report::OtherRow::kNone;
}

}  // namespace mpm::app
