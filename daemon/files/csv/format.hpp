#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/files/csv/layout.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::files {

/// How a data file is written.
struct CsvFormat {
  char delimiter = ',';
  TimeStyle times = {};
  Layout layout = {};
  DateOrder order = DateOrder::kUnknown;  ///< of dates that may be read either way
  bool zero_is_good = false;              ///< in quality codes; not those of `<tag>.quality`
  /// Samples of tags with times of their own that may be a row, 0 = none.
  std::int64_t together_ns = 0;

  [[nodiscard]] bool decimal_comma() const { return delimiter != ','; }
};

/// Finds the header and what it says, and reads on until nothing is open that only other rows tell:
/// the order of day and month, which quality codes there are. Then `lines` stands on the header,
/// whose cells are in `header`; what was assumed is added to `notices`. `sample_time_s` of the
/// unit, 0 = not known; `tags` of the unit, null = not known. Throws config::InputError where there
/// is no header, or the times are the day numbers of a spreadsheet.
[[nodiscard]] CsvFormat find_format(LineReader& lines, const TimeStyle& times, double sample_time_s,
                                    const TagTable* tags, std::vector<Cell>& header,
                                    std::vector<std::string>& notices);

/// The time cell of a row, `date time` where it is in two columns.
[[nodiscard]] std::string time_text(const std::vector<Cell>& cells, const TimeColumns& columns);
/// Moves `lines` to that line, from its beginning.
void return_to(LineReader& lines, int line);

}  // namespace mpm::files
