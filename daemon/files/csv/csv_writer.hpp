#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "daemon/files/csv/column.hpp"
#include "daemon/files/times/time_zone.hpp"

namespace mpm::files {

enum class CsvLayout { kWide, kLong };

struct CsvOptions {
  CsvLayout layout = CsvLayout::kWide;
  bool seconds = false;                  ///< times as seconds since 1970
  std::shared_ptr<const TimeZone> zone;  ///< of ISO 8601 times; null = UTC
  std::vector<bool> quality;             ///< per column: has one of its own (wide only)
};

/// The name that stands for standard output.
inline constexpr const char* kStandardOutput = "-";

/// Writes a data file that `CsvReader` reads back bit by bit: numbers in the fewest digits that
/// give the same double, times to the nanosecond. Missing values are empty cells.
class CsvWriter {
 public:
  /// `name`: of what `out` writes to, for messages. Throws std::invalid_argument where a tag cannot
  /// stand in a CSV file or stands there twice.
  CsvWriter(std::ostream& out, std::string name, std::vector<Column> columns, CsvOptions options);

  /// Throws config::InputError for a time that `CsvReader` would not read.
  void write(const Frame& frame);
  /// Throws std::runtime_error where not everything could be written.
  void finish();
  /// What is buffered comes on top.
  [[nodiscard]] std::uint64_t bytes_written() const { return bytes_; }

 private:
  void write_wide(const Frame& frame);
  void write_long(const Frame& frame);
  void add_value(double value);
  void set_time(std::int64_t time_ns);
  void drain();
  [[noreturn]] void fail() const;

  std::ostream& out_;
  std::string name_;
  std::uint64_t bytes_ = 0;
  std::vector<Column> columns_;
  std::vector<std::string> cells_;  ///< the tags, quoted where needed
  CsvOptions options_;
  std::string buffer_;
  std::string time_;
};

/// True where an empty cell would not tell the quality: of a value that is there, not good.
[[nodiscard]] bool needs_quality(const SignalBlock& block, int index);

}  // namespace mpm::files
