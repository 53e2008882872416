#include "daemon/files/csv/line_frames.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "config/finding.hpp"
#include "core/signal/nanoseconds.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/layout.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/times/local_times.hpp"

namespace mpm::files {
namespace {

constexpr double kLargestInterval = 9e15;  // exact in a double
constexpr int kDeepest = 16;               // lists and objects in each other
constexpr std::size_t kMostTold = 100;     // names that are ignored

std::string in_quotes(const std::string& text) { return "'" + printable(text) + "'"; }

}  // namespace

class LineFrames::Rows {
 public:
  Rows() = default;
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  virtual ~Rows() = default;

  /// `interval`: where the line gives it.
  [[nodiscard]] virtual bool next(Frame& frame, std::optional<std::int64_t>& interval) = 0;
  std::vector<std::string> notices;

 protected:
  void tell(LineReader& lines) {
    if (std::optional<std::string> notice = lines.take_notice())
      notices.push_back(std::move(*notice));
  }
};

namespace {

class CsvRows : public LineFrames::Rows {
 public:
  /// `lines` stands on the header.
  CsvRows(LineReader lines, const config::UnitConfig& unit, const TimeStyle& times,
          std::array<bool, kSignalKindCount>& absent)
      : lines_(std::move(lines)), tags_(unit) {
    CsvFormat format;
    format.delimiter = find_delimiter(lines_.text());
    format.times = times;
    std::vector<Cell> header;
    lines_.split(format.delimiter, header);
    const std::optional<Layout> layout = find_layout(header, &tags_);
    if (!layout)
      lines_.fail(
          1, "the first column must be `time`, not '" + std::string(header.front().text) + "'");
    if (layout->is_long)
      lines_.fail(1,
                  "rows `tag,time,value` cannot be published as they come: convert them to "
                  "`time,<tag>,...` first");
    format.layout = *layout;
    rows_ = read_wide(lines_, format, header, tags_, unit.counts(), notices);
    const auto seen = [this](const std::string& tag) { return !tag.empty() && tags_.seen(tag); };
    absent[static_cast<std::size_t>(SignalKind::kSetpoint)] =
        std::none_of(unit.cv.begin(), unit.cv.end(),
                     [&](const config::CvSignal& cv) { return seen(cv.setpoint); });
    const std::vector<std::string> told = tags_.notices();
    notices.insert(notices.end(), told.begin(), told.end());
  }

  [[nodiscard]] bool next(Frame& frame, std::optional<std::int64_t>&) override {
    const bool there = rows_->next(frame);
    tell(lines_);
    return there;
  }

 private:
  LineReader lines_;
  TagTable tags_;
  std::unique_ptr<RowSource> rows_;
};

class JsonRows : public LineFrames::Rows {
 public:
  /// `lines` stands on the first object.
  JsonRows(LineReader lines, const config::UnitConfig& unit, const TimeStyle& times)
      : lines_(std::move(lines)), tags_(unit), counts_(unit.counts()), times_(times) {}

  [[nodiscard]] bool next(Frame& frame, std::optional<std::int64_t>& interval) override {
    if (!std::exchange(on_line_, false) && !lines_.next()) return false;
    tell(lines_);
    const nlohmann::json line = parse();
    if (!line.is_object()) lines_.fail(1, "is no JSON object");
    clear(frame, counts_);
    const auto time = line.find("time");
    if (time == line.end()) lines_.fail(1, "has no \"time\"");
    std::string problem;
    const std::optional<std::int64_t> time_ns = times_.read(text_of(*time), "", problem);
    if (!time_ns) fail_at("time", "\"time\": " + in_quotes(text_of(*time)) + " " + problem);
    frame.source_time_ns = *time_ns;
    for (const auto& [name, value] : line.items()) {
      if (name == "interval")
        interval = read_interval(value);
      else if (name != "time")
        read_member(name, value, frame);
    }
    return true;
  }

 private:
  nlohmann::json parse() const {
    std::string name;  // of the member at hand
    std::set<std::string> names;
    std::optional<std::string> twice;
    const auto note_name = [&](int depth, nlohmann::json::parse_event_t event,
                               nlohmann::json& key) {
      if (event == nlohmann::json::parse_event_t::key) {
        name = key.get<std::string>();
        if (depth == 1 && !names.insert(name).second) twice = name;
      }
      return depth <= kDeepest;  // what is below is no value, and would cost memory
    };
    try {
      nlohmann::json line = nlohmann::json::parse(lines_.text(), note_name);
      if (twice) fail_at(*twice, in_quotes(*twice) + " is given twice");
      return line;
    } catch (const nlohmann::json::parse_error& error) {
      lines_.fail(static_cast<int>(error.byte), "is no JSON");
    } catch (const nlohmann::json::exception&) {  // a number that no double holds
      fail_at(name, in_quotes(name) + " is out of range");
    }
  }

  /// Fails at the value of a member.
  [[noreturn]] void fail_at(const std::string& name, const std::string& message) const {
    const std::string key = nlohmann::json(name).dump();
    const std::string& line = lines_.text();
    for (std::size_t at = line.find(key); at != std::string::npos; at = line.find(key, at + 1)) {
      const std::size_t colon = line.find_first_not_of(" \t", at + key.size());
      if (colon == std::string::npos || line[colon] != ':') continue;
      lines_.fail(static_cast<int>(line.find_first_not_of(" \t", colon + 1)) + 1, message);
    }
    lines_.fail(1, message);  // the name is written with escapes
  }

  // Not what is inside of a list or an object: that may be deep, and no value is one.
  static std::string shown(const nlohmann::json& value) {
    if (value.is_array()) return "[...]";
    return value.is_object() ? "{...}" : printable(value.dump());
  }

  static std::string text_of(const nlohmann::json& value) {
    return value.is_string() ? value.get<std::string>() : shown(value);
  }

  std::int64_t read_interval(const nlohmann::json& value) const {
    if (!value.is_number_integer() || std::abs(value.get<double>()) > kLargestInterval)
      fail_at("interval", "\"interval\": " + shown(value) + " is no interval number");
    return value.get<std::int64_t>();
  }

  void read_member(const std::string& name, const nlohmann::json& value, Frame& frame) {
    if (const Slot* slot = tags_.find(name)) {
      const std::optional<double> number =
          value.is_null() ? parse_value("", false) : parse_value(text_of(value), false);
      if (!number) fail_at(name, in_quotes(name) + ": " + shown(value) + " is no number");
      frame[slot->kind].values(slot->index) = *number;
      Quality& quality = quality_of(frame, *slot);
      if (std::isfinite(*number)) quality = Quality::kGood;
      return;
    }
    const std::size_t suffix = name.size() - std::min(name.size(), kQualitySuffix.size());
    if (name.substr(suffix) == kQualitySuffix) return read_quality(name, value, suffix, frame);
    if (told_.size() < kMostTold && told_.insert(name).second)
      notices.push_back("ignored, since the unit file does not name it: " + printable(name));
  }

  // Members come in the order of their names, so a quality follows its value; no value stays bad.
  void read_quality(const std::string& name, const nlohmann::json& value, std::size_t suffix,
                    Frame& frame) {
    const Slot* slot = tags_.find(name.substr(0, suffix));
    if (slot == nullptr) return;
    const std::optional<Quality> said = parse_quality(text_of(value));
    if (!said)
      fail_at(name, in_quotes(name) + ": " + shown(value) +
                        " is no quality: good, uncertain, bad or an OPC code");
    Quality& quality = quality_of(frame, *slot);
    quality = std::max(quality, *said);
  }

  static Quality& quality_of(Frame& frame, const Slot& slot) {
    return frame[slot.kind].quality[static_cast<std::size_t>(slot.index)];
  }

  LineReader lines_;
  TagTable tags_;
  SignalCounts counts_;
  LocalTimes times_;
  std::set<std::string> told_;
  bool on_line_ = true;
};

}  // namespace

LineFrames::LineFrames(std::unique_ptr<std::istream> input, const std::string& name,
                       LineFormat format, const config::UnitConfig& unit, const TimeStyle& times)
    : sample_time_s_(unit.sample_time_s) {
  LineReader lines(std::move(input), name);
  if (!lines.next()) lines.fail(1, 1, "nothing came");
  const std::size_t first = lines.text().find_first_not_of(" \t");
  if (format == LineFormat::kAuto)
    format = lines.text()[first] == '{' ? LineFormat::kJson : LineFormat::kCsv;
  if (format == LineFormat::kJson)
    rows_ = std::make_unique<JsonRows>(std::move(lines), unit, times);
  else
    rows_ = std::make_unique<CsvRows>(std::move(lines), unit, times, absent_);
}

LineFrames::~LineFrames() = default;

bool LineFrames::next(Frame& frame) {
  std::optional<std::int64_t> interval;
  if (!rows_->next(frame, interval)) return false;
  if (!std::exchange(started_, true)) first_ns_ = frame.source_time_ns;
  const auto elapsed_ns = static_cast<double>(frame.source_time_ns - first_ns_);
  const double elapsed = elapsed_ns / (sample_time_s_ * kNsPerSecond);
  frame.interval =
      interval.value_or(std::llround(std::clamp(elapsed, -kLargestInterval, kLargestInterval)));
  return true;
}

std::vector<std::string> LineFrames::take_notices() { return std::exchange(rows_->notices, {}); }

}  // namespace mpm::files
