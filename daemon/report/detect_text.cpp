#include "daemon/report/detect_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "config/suggest.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/report/channel_text.hpp"
#include "daemon/report/matrix_text.hpp"
#include "daemon/report/moment_text.hpp"
#include "daemon/report/worst_tags.hpp"

namespace mpm::report {
namespace {

void add_once(std::vector<std::string>& tags, const std::string& tag) {
  if (std::find(tags.begin(), tags.end(), tag) == tags.end()) tags.push_back(tag);
}

/// To two digits.
double rounded_up(double count) {
  const double step = std::pow(10.0, std::max(0.0, std::floor(std::log10(count)) - 1.0));
  return std::ceil(count / step) * step;
}

std::string head(const DetectReport& report, const MomentText& moment) {
  std::string text = printable(report.unit) + ": " + counted(report.samples, "sample");
  if (report.first_ns == report.last_ns)
    text += " at " + moment.with_year(report.last_ns) + moment.zone();
  else
    text += " from " + moment.with_year(report.first_ns) + " to " +
            moment.with_year(report.last_ns) + moment.zone() +
            (report.last_ns < report.first_ns ? ", the clock went back" : "");
  if (report.used.size() > 1) text += ", in " + std::to_string(report.used.size()) + " stretches";
  text += "; " + std::to_string(report.used_samples) + " used";
  if (report.missing > 0) text += ", " + std::to_string(report.missing) + " missing";
  if (report.out_of_order > 0) text += ", " + std::to_string(report.out_of_order) + " out of order";
  text +=
      report.bad_values == 0 ? ", no bad values" : ", " + counted(report.bad_values, "bad value");
  std::string looks;
  const auto look = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) looks += (looks.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  look(report.frozen, "frozen");
  look(report.clipped, "clipped");
  look(report.spikes, report.spikes == 1 ? "spike" : "spikes");
  if (!looks.empty()) text += " (" + looks + ")";
  return text + worst_tags(report.bad_tags);
}

/// Empty where there are none.
std::string on_predictions(const char* before, const std::vector<std::string>& predictions,
                           const char* behind, std::size_t width) {
  if (predictions.empty()) return "";
  std::vector<std::string> tags;
  tags.reserve(predictions.size());
  for (const std::string& tag : predictions) tags.push_back(printable(tag));
  return wrapped(before + config::join(tags) + behind, 0, width) + '\n';
}

std::string corrected_text(const DetectReport& report, std::size_t width) {
  return on_predictions("Not used: ", report.corrected_predictions,
                        ". What stands there is corrected by the measurement, as a controller's "
                        "bias update does, and hides what is wrong with a gain; the unit file's "
                        "model is simulated instead",
                        width);
}

std::string other_text(const DetectReport& report, std::size_t width) {
  return on_predictions("Of another model: ", report.other_predictions,
                        ". What stands there is not what the unit file's model gives of the same "
                        "inputs. The verdicts are on those predictions, mpm diagnose is on the "
                        "file's model: see which of the two the controller runs",
                        width);
}

std::string seldom_text(const DetectReport& report, std::size_t width) {
  if (report.read_every.empty()) return "";
  std::vector<std::string> cvs;
  for (const auto& [tag, samples] : report.read_every)
    cvs.push_back(printable(tag) + " every " + number_text(samples) + " samples");
  return wrapped("Read seldom: " + config::join(cvs) + "; judged at the readings", 0, width) + '\n';
}

std::string other_row_line(const DetectReport& report, std::size_t width) {
  const std::string text = other_row_text(report.other_row);
  return text.empty() ? text : wrapped(text, 0, width) + '\n';
}

/// A few rows are told by their number alone.
std::string order_text(const DetectReport& report, std::size_t width) {
  if (100 * report.out_of_order <= report.samples) return "";
  return wrapped("Left out: " + std::to_string(report.out_of_order) +
                     " rows, for their time does not grow. Where that comes of time stamps that "
                     "jitter by more than half a sample, the others are beside the wrong inputs, "
                     "too: export them with the times at which they were read",
                 0, width) +
         '\n';
}

MatrixCell cell_of(const ChannelRecord& channel) {
  MatrixCell cell{"u", Tint::kGrey};
  if (channel.verdict == Verdict::kMatch) cell = {"m", Tint::kGreen};
  if (channel.verdict == Verdict::kMismatch)
    cell = channel.material ? MatrixCell{"X", Tint::kRed} : MatrixCell{"x", Tint::kPlain};
  if (channel.alarm == AlarmState::kActive) cell = {cell.text + "!", Tint::kRed};
  return cell;
}

std::string legend(const std::vector<MatrixRow>& rows) {
  std::string text;
  const auto explain = [&](char mark, const char* meaning) {
    for (const MatrixRow& row : rows)
      for (const MatrixCell& cell : row.cells)
        if (cell.text.find(mark) != std::string::npos) {
          text += (text.empty() ? "" : ", ") + std::string(1, mark) + " " + meaning;
          return;
        }
  };
  explain('m', "match");
  explain('X', "mismatch");
  explain('x', "mismatch that is not sure to matter");
  explain('u', "undetermined");
  explain('!', "in alarm");
  return text;
}

std::string matrix(const std::vector<ChannelRecord>& channels, const Layout& layout) {
  std::vector<std::string> inputs, cvs;
  for (const ChannelRecord& channel : channels) {
    add_once(inputs, channel.mv);
    add_once(cvs, channel.cv);
  }
  std::vector<MatrixRow> rows;
  rows.reserve(inputs.size());
  for (const std::string& input : inputs)
    rows.push_back({printable(input), std::vector<MatrixCell>(cvs.size())});
  for (const ChannelRecord& channel : channels) {
    const auto row = std::find(inputs.begin(), inputs.end(), channel.mv) - inputs.begin();
    const auto column = std::find(cvs.begin(), cvs.end(), channel.cv) - cvs.begin();
    rows[static_cast<std::size_t>(row)].cells[static_cast<std::size_t>(column)] = cell_of(channel);
  }
  std::vector<std::string> columns;
  columns.reserve(cvs.size());
  for (const std::string& cv : cvs) columns.push_back(printable(cv));
  return matrix_text(columns, rows, layout) + '\n' + wrapped(legend(rows), 2, layout.width);
}

/// The lines of a report.
class Teller {
 public:
  Teller(const DetectReport& report, const config::UnitConfig& unit, const Layout& layout,
         const MomentText& moment)
      : report_(report), unit_(unit), layout_(layout), moment_(moment) {}

  using Say = std::function<std::string(const ChannelRecord&)>;
  /// A line for each channel of which there is something to say.
  void section(const char* title, const Say& say) {
    bool begun = false;
    for (const ChannelRecord& channel : report_.channels) {
      const std::string text = say(channel);
      if (text.empty()) continue;
      if (!begun) text_ += '\n' + layout_.paint(Tint::kBold, title) + '\n';
      begun = true;
      text_ += wrapped(name_of(channel) + ": " + text, 2, layout_.width);
    }
  }

  [[nodiscard]] std::string problem(const ChannelRecord& channel) const {
    const bool alarm = channel.alarm == AlarmState::kActive;
    if (channel.verdict == Verdict::kMismatch)
      return mismatch_text(channel, channel_file(unit_, channel.mv, channel.cv)) + since(channel);
    return alarm && channel.verdict == Verdict::kMatch
               ? "matches by now, still in alarm" + since(channel)
               : "";
  }

  [[nodiscard]] std::string open(const ChannelRecord& channel) const {
    if (channel.verdict != Verdict::kUndetermined) return "";
    std::string text = undetermined_text(channel, channel_file(unit_, channel.mv, channel.cv));
    const auto needed = report_.samples_needed.find(channel.cv);
    if (channel.reason == Reason::kWarmingUp && needed != report_.samples_needed.end() &&
        needed->second > 0.0)
      text += "; needs about " + number_text(rounded_up(needed->second)) + " more";
    return channel.alarm == AlarmState::kActive ? text + "; in alarm" + since(channel) : text;
  }

  [[nodiscard]] std::string past(const ChannelRecord& channel) const {
    std::string text;
    const AlarmRecord* raised = nullptr;
    for (const AlarmRecord& alarm : report_.alarms) {
      if (alarm.mv != channel.mv || alarm.cv != channel.cv) continue;
      if (alarm.to == AlarmChange::kActive) raised = &alarm;
      if (alarm.to != AlarmChange::kCleared || raised == nullptr) continue;
      text += (text.empty() ? "from " : ", from ") + moment_(raised->source_time_ns) + " to " +
              moment_(alarm.source_time_ns);
      raised = nullptr;
    }
    return text;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  // ", since 14:20 on 3 March" of an alarm that stands.
  [[nodiscard]] std::string since(const ChannelRecord& channel) const {
    if (channel.alarm != AlarmState::kActive) return "";
    const auto raised = std::find_if(report_.alarms.rbegin(), report_.alarms.rend(),
                                     [&channel](const AlarmRecord& alarm) {
                                       return alarm.mv == channel.mv && alarm.cv == channel.cv &&
                                              alarm.to == AlarmChange::kActive;
                                     });
    return raised == report_.alarms.rend() ? "" : ", since " + moment_(raised->source_time_ns);
  }

  // Both tags and what stands around them in one line.
  [[nodiscard]] std::string name_of(const ChannelRecord& channel) const {
    const std::size_t longest = std::max<std::size_t>(layout_.width / 2, 8) - 5;
    return shortened(printable(channel.mv), longest) + " -> " +
           shortened(printable(channel.cv), longest);
  }

  const DetectReport& report_;
  const config::UnitConfig& unit_;
  const Layout& layout_;
  const MomentText& moment_;
  std::string text_;
};

}  // namespace

std::string to_text(const DetectReport& report, const config::UnitConfig& unit,
                    const Layout& layout, const files::TimeZone* zone) {
  const MomentText moment(report.last_ns, unit.sample_time_s, zone);
  Teller teller(report, unit, layout, moment);
  teller.section("Mismatch", [&](const auto& channel) { return teller.problem(channel); });
  teller.section("Not linear", [](const auto& channel) { return nonlinear_text(channel); });
  teller.section("Undetermined", [&](const auto& channel) { return teller.open(channel); });
  teller.section("Alarms that are over", [&](const auto& channel) { return teller.past(channel); });
  return wrapped(head(report, moment), 0, layout.width) + '\n' + seldom_text(report, layout.width) +
         corrected_text(report, layout.width) + other_text(report, layout.width) +
         order_text(report, layout.width) + other_row_line(report, layout.width) +
         matrix(report.channels, layout) + teller.text();
}

}  // namespace mpm::report
