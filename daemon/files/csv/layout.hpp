#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/files/csv/csv_line.hpp"
#include "daemon/files/csv/quality.hpp"
#include "daemon/files/csv/tag_table.hpp"

namespace mpm::files {

/// Where the time stands: in one column, or the date in one and the time of day in another.
struct TimeColumns {
  std::size_t time = 0;
  std::optional<std::size_t> clock;
};

inline constexpr std::string_view kQualitySuffix = ".quality";

/// A column that says what the values of another one are worth.
struct QualityColumn {
  std::size_t cell = 0;
  std::size_t value = 0;  ///< the column that it qualifies
  QualityKind kind = QualityKind::kCode;
  bool sure = false;  ///< `<tag>.quality`: a word that is none is an error, 0 is bad
};

/// A tag with a time column of its own.
struct PairedColumns {
  std::size_t time = 0, value = 0;
  std::string name;  ///< empty where none stands at the columns themselves
};

/// What the columns of a file are, by their names. Either one row for each time, with a column for
/// each tag, or one row for each tag and time, or columns of times and values in turn.
struct Layout {
  bool is_long = false;
  std::size_t width = 0;  ///< columns; without what a delimiter at the end makes
  TimeColumns time;
  std::size_t tag = 0, value = 0;        ///< of a long table
  std::vector<std::size_t> others;       ///< of one: where the value is if that cell is empty
  std::vector<std::size_t> values;       ///< of a wide one: columns with the values of a tag
  std::vector<PairedColumns> pairs;      ///< of columns in turn; `time` is the first one's
  std::vector<QualityColumn> qualities;  ///< several may qualify one column: the worst counts
  std::vector<std::string> orphans;      ///< `.quality` columns of tags that have none
  std::size_t without_name = 0;          ///< columns
};

/// Nothing where no column is a time by its name. `tags`: what is named there is a signal, whatever
/// it is called; null = not known.
[[nodiscard]] std::optional<Layout> find_layout(const std::vector<Cell>& header,
                                                const TagTable* tags);
/// The same where it is known which column is the time.
[[nodiscard]] Layout layout_with_time(const std::vector<Cell>& header, TimeColumns time,
                                      const TagTable* tags);

/// The same where several columns are times, each of those behind it up to the next one.
[[nodiscard]] Layout layout_of_pairs(const std::vector<Cell>& header,
                                     const std::vector<std::size_t>& times);

}  // namespace mpm::files
