#include "sim/output/csv_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace mpm::sim {
namespace {

/// Tags with a comma, a quote or a line break are quoted (RFC 4180).
std::string quoted(const std::string& tag) {
  if (tag.find_first_of(",\"\r\n") == std::string::npos) return tag;
  std::string result = "\"";
  for (const char letter : tag) {
    if (letter == '"') result += '"';
    result += letter;
  }
  return result + '"';
}

}  // namespace

CsvWriter::CsvWriter(std::ostream& out, const config::UnitConfig& unit, double start_s,
                     const std::vector<std::string>& quality_tags)
    : out_(out), sample_time_s_(unit.sample_time_s), start_s_(start_s) {
  line_ = "time";
  const auto add = [&](const std::string& tag, SignalKind kind, std::size_t index) {
    if (tag.empty()) return;
    const bool has_quality =
        std::find(quality_tags.begin(), quality_tags.end(), tag) != quality_tags.end();
    columns_.push_back({kind, static_cast<int>(index), has_quality});
    line_ += ',' + quoted(tag);
    if (has_quality) line_ += ',' + quoted(tag + ".quality");
  };
  for (std::size_t i = 0; i < unit.cv.size(); ++i)
    add(unit.cv[i].setpoint, SignalKind::kSetpoint, i);
  for (std::size_t i = 0; i < unit.mv.size(); ++i) add(unit.mv[i].tag, SignalKind::kMv, i);
  for (std::size_t i = 0; i < unit.dv.size(); ++i) add(unit.dv[i].tag, SignalKind::kDv, i);
  for (std::size_t i = 0; i < unit.cv.size(); ++i) add(unit.cv[i].tag, SignalKind::kCv, i);
  for (std::size_t i = 0; i < unit.cv.size(); ++i)
    add(unit.cv[i].prediction, SignalKind::kPrediction, i);
  for (std::size_t i = 0; i < unit.aux.size(); ++i)
    if (!unit.simulation.process.empty() ||
        (i < unit.simulation.aux_movement.size() && unit.simulation.aux_movement[i].sigma > 0.0))
      add(unit.aux[i].tag, SignalKind::kAux, i);
  out_ << line_ << '\n';
}

void CsvWriter::write(const Frame& frame, double time_error_s) {
  line_.clear();
  append(start_s_ + static_cast<double>(frame.interval) * sample_time_s_ + time_error_s);
  for (const Column& column : columns_) {
    line_ += ',';
    append(frame[column.kind].values(column.index));
    if (!column.has_quality) continue;
    constexpr const char* kNames[] = {",good", ",uncertain", ",bad"};
    line_ += kNames[static_cast<std::size_t>(
        frame[column.kind].quality[static_cast<std::size_t>(column.index)])];
  }
  line_ += '\n';
  out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

void CsvWriter::append(double value) {
  if (!std::isfinite(value)) return;  // an empty field is a missing value
  std::array<char, 32> text;
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  line_.append(text.data(), end.ptr);
}

}  // namespace mpm::sim
