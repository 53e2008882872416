#include "daemon/files/csv/format.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "config/suggest.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/column_names.hpp"
#include "daemon/files/times/date_order.hpp"
#include "daemon/files/times/serial_dates.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr int kLinesAbove = 20;     // that may stand above a header
constexpr int kRowsBelow = 3;       // that may stand between a header and the first time
constexpr std::size_t kRows = 200;  // read of any file
constexpr double kSecondsPerNs = 1e-9;
constexpr double kTogether = 0.25;  // of the sample time: what a scan takes, and what is not late

bool is_date(const TimeStyle& times, std::string_view text) {
  return times.format ? times.format->parse(text).has_value() : parse_calendar(text).has_value();
}

bool is_number(std::string_view text) {
  std::string problem;
  return parse_seconds(text, problem).has_value();
}

/// The header at hand, on line `line`.
struct Header {
  int line = 0;
  char delimiter = ',';
  Layout layout;
  bool by_name = false;  ///< the time column is called as one
};

std::vector<Cell> split_header(LineReader& lines, char delimiter) {
  std::vector<Cell> header;
  lines.split(delimiter, header);
  if (header.size() > 1 && header.back().text.empty()) header.pop_back();  // a delimiter at the end
  return header;
}

/// True where the line above has the names of the columns, and the one at hand their units with a
/// word for the time before them.
bool names_stand_above(const std::vector<bool>& above, const Layout& layout) {
  if (layout.is_long || above.size() < layout.width || above[layout.time.time]) return false;
  return std::count(above.begin(), above.end(), true) + 1 >=
         static_cast<std::ptrdiff_t>(layout.width);
}

/// Names of the line above for pairs of columns that have none: over the value, else over the time.
void take_names_above(const std::vector<std::string>& names, Layout& layout) {
  const auto name = [&names](std::size_t i) { return i < names.size() ? names[i] : std::string(); };
  for (PairedColumns& pair : layout.pairs) {
    if (pair.name.empty()) pair.name = name(pair.value);
    if (pair.name.empty()) pair.name = name(pair.time);
  }
}

std::optional<Header> header_by_name(LineReader& lines, const TagTable* tags) {
  std::vector<bool> above;  // which cells of the line before are not empty
  std::vector<std::string> names_above;
  int line_above = 0;
  char delimiter_above = 0;
  for (int i = 0; i <= kLinesAbove && (i == 0 || lines.next()); ++i) {
    const char delimiter = find_delimiter(lines.text());
    const std::vector<Cell> cells = split_header(lines, delimiter);
    if (cells.size() < 2) continue;
    if (std::optional<Layout> layout = find_layout(cells, tags)) {
      if (!layout->pairs.empty()) {
        take_names_above(names_above, *layout);
        return Header{lines.number(), delimiter, *layout, true};
      }
      if (delimiter != delimiter_above || !names_stand_above(above, *layout))
        return Header{lines.number(), delimiter, *layout, true};
      return_to(lines, line_above);
      const std::vector<Cell> names = split_header(lines, delimiter);
      return Header{line_above, delimiter, layout_with_time(names, layout->time, tags), true};
    }
    above.clear();
    names_above.clear();
    for (const Cell& cell : cells) {
      above.push_back(!cell.text.empty());
      names_above.emplace_back(cell.text);
    }
    line_above = lines.number();
    delimiter_above = delimiter;
  }
  return std::nullopt;
}

/// Whether columns of dates have a column of values each: one of the two has a name, or all the
/// dates have the same. Else they are dates of something else.
bool are_pairs(const std::vector<Cell>& header, const std::vector<std::size_t>& dates) {
  if (dates.size() < 2 || dates[1] < 2 || dates.back() >= header.size()) return false;
  return std::all_of(dates.begin(), dates.end(), [&](std::size_t date) {
    const bool nameless = date + 1 >= header.size() || header[date + 1].text.empty();
    return nameless || header[date].text.empty() || header[date].text == header[dates[0]].text;
  });
}

/// A first column of any name, with dates below.
std::optional<Header> header_by_dates(LineReader& lines, int line, const TimeStyle& times,
                                      const TagTable* tags) {
  return_to(lines, line);
  const char delimiter = find_delimiter(lines.text());
  for (int i = 0; i <= kRowsBelow && lines.next(); ++i) {
    const std::vector<Cell> cells = split_header(lines, delimiter);
    if (cells.size() < 2 || !is_date(times, cells[0].text)) continue;
    std::vector<std::size_t> dates;
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      if (is_date(times, cells[cell].text)) dates.push_back(cell);
    return_to(lines, line);
    const std::vector<Cell> header = split_header(lines, delimiter);
    const bool pairs = are_pairs(header, dates);
    return Header{line, delimiter,
                  pairs ? layout_of_pairs(header, dates) : layout_with_time(header, {}, tags),
                  false};
  }
  return std::nullopt;
}

/// What the rows below a header tell.
class Survey {
 public:
  Survey(LineReader& lines, CsvFormat& format, double sample_time_s)
      : lines_(lines),
        format_(format),
        sample_time_s_(sample_time_s),
        checked_(format.layout.qualities.size()) {}

  void run() {
    for (std::size_t row = 0; (row < kRows || open()) && lines_.next(); ++row) {
      lines_.split(format_.delimiter, cells_);
      if (cells_.size() < format_.layout.width) continue;
      look_at_times();
      look_at_qualities();
      if (row + 1 == kRows) check_serial_dates();
    }
    check_serial_dates();
    format_.order = dates_.order();
    format_.zero_is_good = codes_ == Codes::kZeroIsGood;
    drop_what_is_no_quality();
  }

  void tell(const std::vector<Cell>& header, std::vector<std::string>& notices) const {
    if (const std::string notice = dates_.notice(); !notice.empty()) notices.push_back(notice);
    std::vector<std::string> names;
    for (const QualityColumn& column : format_.layout.qualities)
      if (!column.sure &&
          std::find(names.begin(), names.end(), header[column.cell].text) == names.end())
        names.emplace_back(header[column.cell].text);
    if (!names.empty()) notices.push_back("quality is read from " + config::join(names));
    if (format_.zero_is_good)
      notices.emplace_back(
          "the quality codes are taken as 0 good, 1 bad, 16 doubtful: no other ones are there, "
          "such "
          "as OPC's 192");
  }

 private:
  enum class Codes { kNone, kZeroIsGood, kOther };

  [[nodiscard]] bool open() const {
    return (two_numbers_ && !dates_.settled()) || codes_ == Codes::kZeroIsGood;
  }

  void look_at_times() {
    Layout& layout = format_.layout;
    if (layout.pairs.empty()) {
      look_at_time(layout.time, layout.is_long ? cells_[layout.tag].text : std::string_view());
      return;
    }
    for (const PairedColumns& pair : layout.pairs) {
      TimeColumns time{pair.time, std::nullopt};
      look_at_time(time, pair.name);
    }
  }

  /// Days follow one another among the rows of one `series`.
  void look_at_time(TimeColumns& columns, std::string_view series) {
    if (columns.clock && !there_) {
      const std::string_view clock = cells_[*columns.clock].text;
      if (clock.empty()) return;
      const std::string_view date = cells_[columns.time].text;
      const bool remark = !is_date(format_.times, date) && !is_number(date) &&
                          clock.find(':') == std::string_view::npos;
      if (remark || is_date(format_.times, clock))  // the other is a time of its own
        columns = {*columns.clock, std::nullopt};
    }
    const std::string text = time_text(cells_, columns);
    if (text.find_first_of("0123456789") == std::string::npos) return;
    there_ = true;
    if (format_.times.format) return;
    if (columns.clock) refuse_day_number(cells_[columns.time]);
    if (const std::optional<CalendarTime> written = parse_calendar(text)) {
      two_numbers_ = two_numbers_ || written->two_numbers;
      dates_.add(*written, series);
    } else {
      std::string problem;
      const std::optional<std::int64_t> number = parse_seconds(text, problem);
      if (!number || serial_checked_ || columns.time != format_.layout.time.time) return;
      if (days_.empty()) first_number_ = {lines_.number(), cells_[columns.time].column, text};
      days_.push_back(static_cast<double>(*number) * kSecondsPerNs);
    }
  }

  /// Of a date that has a column for the time of day beside it.
  void refuse_day_number(const Cell& date) const {
    std::string none;
    const std::optional<std::int64_t> number = parse_seconds(date.text, none);
    if (!number || serial_checked_) return;
    const std::string problem = serial_day_problem(static_cast<double>(*number) * kSecondsPerNs);
    if (!problem.empty()) lines_.fail(date.column, "'" + std::string(date.text) + "' " + problem);
  }

  void look_at_qualities() {
    const std::vector<QualityColumn>& columns = format_.layout.qualities;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view text = cells_[columns[i].cell].text;
      if (columns[i].sure || text.empty()) continue;
      if (there_ && checked_[i] == Check::kOpen)
        checked_[i] = parse_quality(text, columns[i].kind) ? Check::kIs : Check::kIsNot;
      if (columns[i].kind != QualityKind::kCode || checked_[i] != Check::kIs) continue;
      const std::optional<std::int64_t> code = quality_code(text);
      if (code && codes_ != Codes::kOther)
        codes_ = fits_zero_is_good(*code) ? Codes::kZeroIsGood : Codes::kOther;
    }
  }

  void check_serial_dates() {
    if (std::exchange(serial_checked_, true)) return;
    const std::string problem = serial_date_problem(days_, sample_time_s_);
    if (!problem.empty())
      lines_.fail(first_number_.line, first_number_.column,
                  "'" + first_number_.text + "' " + problem);
  }

  void drop_what_is_no_quality() {
    Layout& layout = format_.layout;
    std::vector<QualityColumn> kept;
    for (std::size_t i = 0; i < layout.qualities.size(); ++i) {
      if (checked_[i] != Check::kIsNot)
        kept.push_back(layout.qualities[i]);
      else if (!layout.is_long && layout.pairs.empty())
        layout.values.push_back(layout.qualities[i].cell);
    }
    std::sort(layout.values.begin(), layout.values.end());
    layout.qualities = std::move(kept);
  }

  enum class Check { kOpen, kIs, kIsNot };
  struct Place {
    int line = 0, column = 0;
    std::string text;
  };

  LineReader& lines_;
  CsvFormat& format_;
  double sample_time_s_;
  std::vector<Cell> cells_;
  bool there_ = false;  ///< a time came
  DateOrderFinder dates_;
  bool two_numbers_ = false;
  std::vector<double> days_;
  Place first_number_;
  bool serial_checked_ = false;
  std::vector<Check> checked_;
  Codes codes_ = Codes::kNone;
};

/// The header may tell the zone of local times; --time-zone has the last word.
void take_zone(const std::vector<Cell>& header, const TimeColumns& columns, TimeStyle& times) {
  for (const std::size_t column : {columns.time, columns.clock.value_or(columns.time)}) {
    if (column >= header.size()) continue;
    const std::string name(header[column].text);
    const std::string zone = zone_in_name(name);
    if (zone.empty()) continue;
    try {
      const auto told = std::make_shared<TimeZone>(zone);
      if (!times.zone) {
        times.zone = told;
        times.zone_said = ", as the header '" + name + "' says";
      } else if (times.zone->name() != zone) {
        times.zone_said = ", as --time-zone says; the header '" + name + "' says " + zone;
      }
      return;
    } catch (const config::InputError&) {  // words that are no zone
    }
  }
}

}  // namespace

std::string time_text(const std::vector<Cell>& cells, const TimeColumns& columns) {
  std::string text(cells[columns.time].text);
  if (columns.clock) text.append(" ").append(cells[*columns.clock].text);
  return text;
}

void return_to(LineReader& lines, int line) {
  lines.rewind();
  while (lines.next() && lines.number() < line) continue;
  if (lines.number() != line) lines.fail(1, "the file changed while it was read");
}

CsvFormat find_format(LineReader& lines, const TimeStyle& times, double sample_time_s,
                      const TagTable* tags, std::vector<Cell>& header,
                      std::vector<std::string>& notices) {
  if (!lines.next()) lines.fail(1, 1, "the file is empty");
  const int first_line = lines.number();
  std::optional<Header> found = header_by_name(lines, tags);
  if (!found) found = header_by_dates(lines, first_line, times, tags);
  if (!found) {
    return_to(lines, first_line);
    header = split_header(lines, find_delimiter(lines.text()));
    lines.fail(header.front().column,
               "the first column must be `time`, not '" + std::string(header.front().text) +
                   "'; if that holds times, say how they are written with --time-format");
  }
  CsvFormat format;
  format.delimiter = found->delimiter;
  format.times = times;
  format.layout = found->layout;
  format.together_ns = std::llround(kTogether * sample_time_s / kSecondsPerNs);
  return_to(lines, found->line);
  header = split_header(lines, format.delimiter);
  take_zone(header, format.layout.time, format.times);
  return_to(lines, found->line);
  Survey survey(lines, format, sample_time_s);
  survey.run();
  return_to(lines, found->line);
  header = split_header(lines, format.delimiter);
  if (found->line != first_line)
    notices.push_back("line " + std::to_string(found->line) +
                      " is taken for the header, what stands above it left out");
  if (!found->by_name)
    notices.push_back("the first column, '" + std::string(header.front().text) +
                      "', is taken for the time");
  survey.tell(header, notices);
  return format;
}

}  // namespace mpm::files
