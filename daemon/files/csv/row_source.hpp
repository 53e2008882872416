#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/signal/frame.hpp"
#include "daemon/files/csv/csv_line.hpp"
#include "daemon/files/csv/tag_table.hpp"
#include "daemon/files/times/local_times.hpp"

namespace mpm::files {

/// The layout of a data file, found from its header.
struct CsvFormat {
  char delimiter = ',';
  std::shared_ptr<const TimeZone> zone = nullptr;  ///< of local times; null = there may be none
  [[nodiscard]] bool decimal_comma() const { return delimiter != ','; }
};

/// Cells that were not taken as they stand in the file.
struct ReadTally {
  std::uint64_t not_finite = 0;  ///< values; taken as missing
  std::uint64_t repeated = 0;    ///< values of a tag at a time that it has already

  /// One line for each kind that there was.
  void tell(std::vector<std::string>& notices) const;
};

/// Frames as they stand in the file: values, qualities and time, not yet numbered.
class RowSource {
 public:
  RowSource() = default;
  RowSource(const RowSource&) = delete;
  RowSource& operator=(const RowSource&) = delete;
  virtual ~RowSource() = default;

  [[nodiscard]] virtual bool next(Frame& frame) = 0;
};

/// Rows `time,<tag>,<tag>,...`; `lines` stands on the header.
[[nodiscard]] std::unique_ptr<RowSource> read_wide(LineReader& lines, const CsvFormat& format,
                                                   const std::vector<Cell>& header, TagTable& tags,
                                                   const SignalCounts& counts,
                                                   std::vector<std::string>& notices);

/// True for the header of the long form: a tag, a time and a value column.
[[nodiscard]] bool is_long_header(const std::vector<Cell>& header);

/// Which column of such a header holds the tags.
[[nodiscard]] std::size_t tag_column(const std::vector<Cell>& header);

/// Rows `tag,time,value,quality`; reads the whole file once to learn its tags and order.
[[nodiscard]] std::unique_ptr<RowSource> read_long(LineReader& lines, const CsvFormat& format,
                                                   const std::vector<Cell>& header, TagTable& tags,
                                                   const SignalCounts& counts,
                                                   std::vector<std::string>& notices);

/// Shared by both: a cell's value, time and quality, or InputError at its place.
[[nodiscard]] double read_value(const LineReader& lines, const CsvFormat& format, const Cell& cell,
                                ReadTally& tally);
[[nodiscard]] std::int64_t read_time(const LineReader& lines, const Cell& cell, LocalTimes& times,
                                     std::string_view series = {});
[[nodiscard]] Quality read_quality(const LineReader& lines, const Cell& cell);
/// True for what a time column may be called.
[[nodiscard]] bool is_time_name(std::string_view name);
/// Gives the frame its size and makes every value missing.
void clear(Frame& frame, const SignalCounts& counts);
/// False for a last line that was cut off while being written (noted); InputError where the number
/// of cells is wrong otherwise.
[[nodiscard]] bool check_width(const LineReader& lines, const std::vector<Cell>& cells,
                               std::size_t width, std::vector<std::string>& notices);

}  // namespace mpm::files
