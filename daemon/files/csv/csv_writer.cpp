#include "daemon/files/csv/csv_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "config/failure_text.hpp"
#include "config/finding.hpp"
#include "core/signal/nanoseconds.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr std::size_t kBufferBytes = 1U << 20U;

std::string cell_of(const std::string& tag) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; };
  if (tag.empty() || std::any_of(tag.begin(), tag.end(), control))
    throw std::invalid_argument("a tag with control characters cannot stand in a CSV file");
  const bool blank_ends =
      tag.front() == ' ' || tag.back() == ' ' || tag.front() == '\t' || tag.back() == '\t';
  if (!blank_ends && tag.find_first_of(",;\t\"#") == std::string::npos) return tag;
  std::string cell = "\"";
  for (const char c : tag) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

const char* name_of(Quality quality) {
  switch (quality) {
    case Quality::kGood:
      return "good";
    case Quality::kUncertain:
      return "uncertain";
    default:
      return "bad";
  }
}

Quality quality_of(const SignalBlock& block, int index) {
  return std::isfinite(block.values(index)) ? block.quality[static_cast<std::size_t>(index)]
                                            : Quality::kBad;
}

}  // namespace

bool needs_quality(const SignalBlock& block, int index) {
  return std::isfinite(block.values(index)) &&
         block.quality[static_cast<std::size_t>(index)] != Quality::kGood;
}

CsvWriter::CsvWriter(std::ostream& out, std::string name, std::vector<Column> columns,
                     CsvOptions options)
    : out_(out),
      name_(std::move(name)),
      columns_(std::move(columns)),
      options_(std::move(options)) {
  options_.quality.resize(columns_.size());
  std::set<std::string> seen;
  for (const Column& column : columns_) {
    cells_.push_back(cell_of(column.tag));
    if (!seen.insert(column.tag).second)
      throw std::invalid_argument("there are two signals '" + column.tag + "'");
  }
  if (options_.layout == CsvLayout::kLong) {
    buffer_ = "tag,time,value,quality\n";
    return;
  }
  buffer_ = "time";
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    buffer_ += ',' + cells_[i];
    if (options_.quality[i]) buffer_ += ',' + cell_of(columns_[i].tag + ".quality");
  }
  buffer_ += '\n';
}

void CsvWriter::set_time(std::int64_t time_ns) {
  if (!moment_ns(time_ns / kSecondNs, 0))
    throw config::InputError(
        {"", 0, 0, config::Severity::kError, "",
         "a row has the time " + utc_text(time_ns) +
             ", which no data file may have (1825 to 2115): the clock of what sent it is wrong; "
             "leave it out with --from, --until or --exclude"});
  if (options_.seconds) {
    time_ = seconds_text(time_ns);
    return;
  }
  const std::int64_t second = floor_division(time_ns, kSecondNs);
  time_ = utc_text(time_ns, options_.zone ? options_.zone->offset_s(second) : 0);
}

void CsvWriter::add_value(double value) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  buffer_.append(text.data(), result.ptr);
}

void CsvWriter::write(const Frame& frame) {
  set_time(frame.source_time_ns);
  if (options_.layout == CsvLayout::kWide)
    write_wide(frame);
  else
    write_long(frame);
  if (buffer_.size() >= kBufferBytes) drain();
}

void CsvWriter::write_wide(const Frame& frame) {
  buffer_ += time_;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const SignalBlock& block = frame[columns_[i].kind];
    buffer_ += ',';
    add_value(block.values(columns_[i].index));
    if (!options_.quality[i]) continue;
    buffer_ += ',';
    buffer_ += name_of(quality_of(block, columns_[i].index));
  }
  buffer_ += '\n';
}

void CsvWriter::write_long(const Frame& frame) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const SignalBlock& block = frame[columns_[i].kind];
    buffer_ += cells_[i];
    buffer_ += ',';
    buffer_ += time_;
    buffer_ += ',';
    add_value(block.values(columns_[i].index));
    buffer_ += ',';
    buffer_ += name_of(quality_of(block, columns_[i].index));
    buffer_ += '\n';
  }
}

void CsvWriter::drain() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  bytes_ += buffer_.size();
  buffer_.clear();
  if (!out_) fail();
}

void CsvWriter::finish() {
  drain();
  out_.flush();
  if (!out_) fail();
}

void CsvWriter::fail() const {
  throw std::runtime_error(name_ + ": cannot be written to: " + config::failure_text(errno));
}

}  // namespace mpm::files
