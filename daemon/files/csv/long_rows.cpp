#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/csv/sample_rows.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kFewestTimes = 20;  // that tell whether tags are sampled together

class LongRows : public SampleRows {
 public:
  LongRows(LineReader& lines, const CsvFormat& format, TagTable& tags, const SignalCounts& counts,
           std::vector<std::string>& notices)
      : SampleRows(lines, format, counts, notices), columns_(format_.layout), tags_(tags) {
    const int header_line = lines_.number();
    const bool sorted = survey();
    const std::string problem = tags.problem();
    if (!problem.empty())
      lines_.fail(
          header_line, 1,
          problem + (named_ ? "" : "; export it with the names that its numbers stand for"));
    return_to(lines_, header_line);
    if (!sorted) gather();
  }

  [[nodiscard]] bool has_own_times() const override { return times() >= kFewestTimes && apart(); }

 private:
  /// Notes every tag; true if the time of those that count never goes back: then also their times.
  bool survey() {
    bool sorted = true;
    std::int64_t last_ns = 0;
    bool first = true;
    const std::size_t told = notices_.size();
    while (next_line()) {
      tags_.see(tag());
      named_ = named_ || tag().find_first_not_of("0123456789") != std::string_view::npos;
      const Slot* slot = tags_.find(tag());
      if (slot == nullptr || is_remark()) continue;
      const std::int64_t time_ns = read_time(lines_, cells_, columns_.time, times_, tag());
      sorted = sorted && (first || time_ns >= last_ns);
      if (sorted) note_time(*slot, time_ns);
      last_ns = time_ns;
      first = false;
    }
    notices_.resize(told);  // a cut-off line is told when it is read again
    times_.restart();
    tally_ = {};
    return sorted;
  }

  [[nodiscard]] std::string_view tag() const { return cells_[columns_.tag].text; }

  [[nodiscard]] const Cell& value() const {
    for (const std::size_t other : columns_.others)
      if (!cells_[other].text.empty()) return cells_[other];
    return cells_[columns_.value];
  }

  bool next_line() {
    do {
      if (!lines_.next()) return false;
      lines_.split(format_.delimiter, cells_);
    } while (is_empty(cells_) && ++tally_.empty_rows > 0);
    return check_width(lines_, format_.delimiter, cells_, columns_.width, notices_);
  }

  /// Neither a value nor a time: units below the header, counts below the data.
  [[nodiscard]] bool is_remark() const {
    const std::string_view said = value().text;
    if (std::isfinite(parse_value(said, format_.decimal_comma()).value_or(NAN))) return false;
    const std::string text = time_text(cells_, columns_.time);
    if (text.find_first_of("0123456789") == std::string::npos) return true;
    std::string problem;
    return said.empty() && !parse_calendar(text) && !LocalTimes(times_).read(text, tag(), problem);
  }

  /// The next line of a tag that the unit names.
  std::optional<Sample> read_sample() override {
    while (next_line()) {
      const Slot* slot = tags_.find(tag());
      if (slot == nullptr) continue;
      if (is_remark()) {
        ++tally_.empty_rows;
        continue;
      }
      return sample_of(tag(), *slot, columns_.time, value(), columns_.qualities);
    }
    return std::nullopt;
  }

  const Layout& columns_;
  TagTable& tags_;
  bool named_ = false;  ///< some tag is no mere number
};

}  // namespace

std::unique_ptr<RowSource> read_long(LineReader& lines, const CsvFormat& format, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  return std::make_unique<LongRows>(lines, format, tags, counts, notices);
}

}  // namespace mpm::files
