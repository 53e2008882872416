#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/signal/frame.hpp"
#include "daemon/files/csv/csv_line.hpp"
#include "daemon/files/csv/format.hpp"
#include "daemon/files/csv/tag_table.hpp"
#include "daemon/files/times/local_times.hpp"

namespace mpm::files {

/// Cells that were not taken as they stand in the file.
struct ReadTally {
  std::uint64_t not_finite = 0;      ///< values; taken as missing
  std::uint64_t repeated = 0;        ///< values of a tag at a time that it has already
  std::uint64_t decimal_commas = 0;  ///< values
  bool may_be_thousands = false;     ///< some value may be a thousand of what it looks like
  std::uint64_t decimal_points = 0;  ///< values, where the comma may be one too
  std::uint64_t empty_rows = 0;      ///< without time and values
  std::map<std::string, std::uint64_t, std::less<>> states;     ///< instead of numbers
  std::map<std::string, std::uint64_t, std::less<>> qualities;  ///< that nobody knows

  /// One line for each kind that there was.
  void tell(std::vector<std::string>& notices) const;
};

/// Of which values a row of the file speaks.
using Told = std::array<std::vector<bool>, kSignalKindCount>;

/// Frames as they stand in the file: values, qualities and time, not yet numbered.
class RowSource {
 public:
  RowSource() = default;
  RowSource(const RowSource&) = delete;
  RowSource& operator=(const RowSource&) = delete;
  virtual ~RowSource() = default;

  [[nodiscard]] virtual bool next(Frame& frame) = 0;
  /// Where rows need not speak of every tag: of which the last frame's did. Null = of all.
  [[nodiscard]] virtual const Told* told() const { return nullptr; }
  /// True where each tag has times of its own, so that most rows speak of few; known from the
  /// start.
  [[nodiscard]] virtual bool has_own_times() const { return false; }
  /// True where values between two times of a tag lie on the line from one to the other, rather
  /// than stay as they were.
  [[nodiscard]] virtual bool has_lines() const { return false; }
  /// With such lines: of a tag of which the last row speaks, what it says next; nothing where it
  /// stays until then.
  struct Next {
    std::int64_t time_ns = 0;
    double value = 0.0;
  };
  [[nodiscard]] virtual std::optional<Next> next_of(SignalKind, std::size_t) const {
    return std::nullopt;
  }
};

/// Rows `time,<tag>,<tag>,...`; `lines` stands on the header.
[[nodiscard]] std::unique_ptr<RowSource> read_wide(LineReader& lines, const CsvFormat& format,
                                                   const std::vector<Cell>& header, TagTable& tags,
                                                   const SignalCounts& counts,
                                                   std::vector<std::string>& notices);

/// Rows `tag,time,value,quality`; reads the whole file once to learn its tags and order.
[[nodiscard]] std::unique_ptr<RowSource> read_long(LineReader& lines, const CsvFormat& format,
                                                   TagTable& tags, const SignalCounts& counts,
                                                   std::vector<std::string>& notices);

/// Columns `time,<tag>,time,<tag>,...`, each tag with times of its own; keeps all of them.
[[nodiscard]] std::unique_ptr<RowSource> read_pairs(LineReader& lines, const CsvFormat& format,
                                                    TagTable& tags, const SignalCounts& counts,
                                                    std::vector<std::string>& notices);

/// The one of these that the layout asks for; `lines` stands on the header.
[[nodiscard]] std::unique_ptr<RowSource> read_rows(LineReader& lines, const CsvFormat& format,
                                                   const std::vector<Cell>& header, TagTable& tags,
                                                   const SignalCounts& counts,
                                                   std::vector<std::string>& notices);

/// Shared by them: a cell's value, time and quality, or InputError at its place. A state instead of
/// a value is missing, an unknown word for a quality bad, and both are counted.
[[nodiscard]] double read_value(const LineReader& lines, const CsvFormat& format, const Cell& cell,
                                ReadTally& tally);
[[nodiscard]] std::int64_t read_time(const LineReader& lines, const std::vector<Cell>& cells,
                                     const TimeColumns& columns, LocalTimes& times,
                                     std::string_view series = {});
[[nodiscard]] Quality read_quality(const LineReader& lines, const CsvFormat& format,
                                   const QualityColumn& column, const Cell& cell, ReadTally& tally);
/// Whether a row has nothing in it.
[[nodiscard]] bool is_empty(const std::vector<Cell>& cells);
/// Gives the frame its size and makes every value missing.
void clear(Frame& frame, const SignalCounts& counts);
/// False, and noted, at the end of the data: for a last line that was cut off while being written,
/// or one where a database says how many rows it gave; InputError where the number of cells is
/// wrong otherwise. `cells` are those of the line.
[[nodiscard]] bool check_width(LineReader& lines, char delimiter, std::vector<Cell>& cells,
                               std::size_t width, std::vector<std::string>& notices);

}  // namespace mpm::files
