#include "daemon/history/trend/trend_csv.hpp"

#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::history {
namespace {

constexpr int kDigits = 6;

std::string cell(double value) { return known(value) ? number_text(value, kDigits) : ""; }

// In quotes where a comma, a quote or the end of a line would part it.
std::string text(const std::string& of) {
  if (of.find_first_of(",\"\n\r") == std::string::npos) return of;
  std::string quoted = "\"";
  for (const char letter : of)
    quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + '"';
}

}  // namespace

std::string to_csv(const Trend& trend) {
  const auto time = [&](std::int64_t time_ns) {
    return trend.dated ? files::utc_text(time_ns) : files::seconds_text(time_ns);
  };
  std::string rows =
      "from,until,mv,cv,samples,residual_rms,prediction_rms,movement_rms,fit_percent,match,"
      "mismatch,undetermined,excited,gain_error_percent,effect_size,low,high\n";
  for (const Period& period : trend.periods) {
    const std::string times = time(period.from_ns) + "," + time(period.until_ns) + ",";
    const std::string samples = "," + std::to_string(period.samples) + ",";
    for (std::size_t j = 0; j < period.cvs.size(); ++j) {
      const CvPeriod& cv = period.cvs[j];
      rows += times + "," + text(trend.head.cvs[j].cv) + samples + cell(cv.residual_rms) + "," +
              cell(cv.prediction_rms) + "," + cell(cv.movement_rms) + "," + cell(cv.fit()) +
              ",,,,,,,,\n";
    }
    for (std::size_t c = 0; c < period.channels.size(); ++c) {
      const ChannelPeriod& channel = period.channels[c];
      const ChannelHead& head = trend.head.channels[c];
      const std::string error = cell(channel.gain_error);
      rows += times + text(head.mv) + "," + text(head.cv) + samples + ",,,," + cell(channel.match) +
              "," + cell(channel.mismatch) + "," + cell(channel.undetermined) + "," +
              cell(channel.excited) + "," + (head.modelled ? error + "," : "," + error) + "," +
              cell(channel.low) + "," + cell(channel.high) + "\n";
    }
  }
  return rows;
}

}  // namespace mpm::history
