#include "daemon/files/csv/step_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "config/engineering_unit.hpp"
#include "config/suggest.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/csv_line.hpp"

namespace mpm::files {
namespace {

constexpr std::size_t kTags = 2;               // cells before the units, or the coefficients
constexpr double kSampleTimeTolerance = 0.01;  // of one

class TableReader {
 public:
  TableReader(const std::string& path, const config::UnitConfig& unit)
      : lines_(open_file(path), path), unit_(unit) {}

  StepTable read() {
    if (!lines_.next()) lines_.fail(1, 1, "holds nothing");
    delimiter_ = find_delimiter(lines_.text());
    lines_.split(delimiter_, cells_);
    bool more = true;
    if (is_header()) {
      read_header();
      more = lines_.next();
    }
    for (; more; more = lines_.next()) read_row();
    if (table_.channels.empty()) lines_.fail(lines_.number(), 1, "holds no step response");
    settle_beginning();
    return std::move(table_);
  }

 private:
  [[nodiscard]] bool is_header() const {
    return cells_.size() >= kTags && same_word(cells_[0].text, "cv") &&
           (same_word(cells_[1].text, "mv") || same_word(cells_[1].text, "dv") ||
            same_word(cells_[1].text, "input"));
  }

  [[nodiscard]] std::optional<double> number(const Cell& cell) const {
    const std::optional<double> value = parse_value(cell.text, delimiter_ != ',');
    return value && std::isfinite(*value) ? value : std::nullopt;
  }

  /// Words above the coefficients are names; numbers are times.
  void read_header() {
    while (coefficients_ < cells_.size() && coefficients_ - kTags < unit_columns_.size() &&
           is_unit_column(cells_[coefficients_].text))
      ++coefficients_;
    if (cells_.size() == coefficients_ || !number(cells_[coefficients_])) return;
    std::vector<double> times_s;
    for (std::size_t i = coefficients_; i < cells_.size(); ++i) {
      const std::optional<double> time_s = number(cells_[i]);
      if (!time_s)
        lines_.fail(cells_[i].column, "'" + printable(cells_[i].text) + "' is no time in s");
      times_s.push_back(*time_s);
    }
    const double sample_s = unit_.sample_time_s;
    const double first = times_s.front() / sample_s;
    begins_at_ = first < 0.5 ? 0 : 1;
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      const double expected = static_cast<double>(i + static_cast<std::size_t>(*begins_at_));
      if (std::abs(times_s[i] / sample_s - expected) > kSampleTimeTolerance)
        lines_.fail(cells_[coefficients_ + i].column,
                    "should be " + number_text(expected * sample_s) +
                        " s: the unit's sample_time is " + number_text(sample_s) + " s");
    }
    width_ = cells_.size();
    width_line_ = lines_.number();
  }

  /// `cv_unit`, `mv_unit`: what stands below are the engineering units of the row's signals.
  bool is_unit_column(std::string_view name) {
    const std::size_t column = coefficients_ - kTags;
    const bool of_cv = same_word(name, "cv_unit") || same_word(name, "cv unit");
    const bool of_input = same_word(name, "mv_unit") || same_word(name, "mv unit") ||
                          same_word(name, "dv_unit") || same_word(name, "dv unit") ||
                          same_word(name, "input_unit") || same_word(name, "input unit");
    if (!of_cv && !of_input) return false;
    unit_columns_[column] = of_cv ? UnitOf::kCv : UnitOf::kInput;
    return true;
  }

  void check_unit(const Cell& cell, const std::string& tag, const std::string& of_unit_file) {
    if (cell.text.empty()) return;
    if (of_unit_file.empty()) {
      if (untold_.insert(tag).second)
        table_.notices.push_back("the unit of '" + tag + "', " + printable(cell.text) +
                                 ", is not compared: the unit file gives none");
      return;
    }
    const auto here = config::EngineeringUnit::parse(cell.text);
    const auto there = config::EngineeringUnit::parse(of_unit_file);
    if (cell.text != of_unit_file && (!here || !there || *here != *there))
      lines_.fail(cell.column, "'" + tag + "' is in " + of_unit_file +
                                   " in the unit file, not in " + printable(cell.text) +
                                   "; nothing is converted");
  }

  void check_units(const ChannelSpec& channel) {
    const auto cv = static_cast<std::size_t>(channel.cv);
    const auto input = static_cast<std::size_t>(channel.input);
    const std::string& input_unit =
        input < unit_.mv.size() ? unit_.mv[input].unit : unit_.dv[input - unit_.mv.size()].unit;
    for (std::size_t i = kTags; i < coefficients_; ++i)
      if (unit_columns_[i - kTags] == UnitOf::kCv)
        check_unit(cells_[i], unit_.cv[cv].tag, unit_.cv[cv].unit);
      else
        check_unit(cells_[i], unit_.input_tag(channel.input), input_unit);
  }

  [[nodiscard]] int place_of(const Cell& cell, const std::vector<std::string>& tags,
                             const char* noun) const {
    const auto found = std::find(tags.begin(), tags.end(), cell.text);
    if (found == tags.end())
      lines_.fail(cell.column, "'" + printable(cell.text) + "' is no " + noun + " of unit '" +
                                   unit_.unit + "'" + config::suggestion(cell.text, tags));
    return static_cast<int>(found - tags.begin());
  }

  void read_row() {
    lines_.split(delimiter_, cells_);
    if (cells_.size() <= coefficients_)
      lines_.fail(1, "a row is cv, mv and the coefficients of their step response");
    ChannelSpec channel;
    channel.cv = place_of(cells_[0], unit_.cv_tags(), "cv");
    channel.input = place_of(cells_[1], unit_.input_tags(), "mv or dv");
    const auto [first, is_new] = rows_.try_emplace({channel.cv, channel.input}, lines_.number());
    if (!is_new)
      lines_.fail(1, "a second step response of this channel; the first is in line " +
                         std::to_string(first->second));
    if (width_ == 0) {
      width_ = cells_.size();
      width_line_ = lines_.number();
    }
    if (cells_.size() != width_)
      lines_.fail(cells_[std::min(cells_.size(), width_) - 1].column,
                  "this row has " + counted(cells_.size() - coefficients_, "coefficient") +
                      ", line " + std::to_string(width_line_) + " has " +
                      std::to_string(width_ - coefficients_));
    check_units(channel);
    StepResponse response;
    for (std::size_t i = coefficients_; i < cells_.size(); ++i) {
      const std::optional<double> value = number(cells_[i]);
      if (!value) lines_.fail(cells_[i].column, "'" + printable(cells_[i].text) + "' is no number");
      response.values.push_back(*value);
    }
    channel.dynamics = std::move(response);
    table_.channels.push_back(std::move(channel));
  }

  /// The first value of a step response is that of the moment of the step.
  void settle_beginning() {
    const auto values_of = [](ChannelSpec& channel) -> std::vector<double>& {
      return std::get<StepResponse>(channel.dynamics).values;
    };
    if (!begins_at_) {
      const bool moves =
          std::any_of(table_.channels.begin(), table_.channels.end(),
                      [&](ChannelSpec& channel) { return values_of(channel).front() != 0.0; });
      begins_at_ = moves ? 1 : 0;
      table_.notices.push_back(
          std::string("the first coefficients are taken for those ") +
          (moves ? "one sample after the step, for not all are 0" : "of the moment of the step") +
          "; times above them (cv,mv,0," + number_text(unit_.sample_time_s) + ",...) would tell");
    }
    if (*begins_at_ == 0) return;
    for (ChannelSpec& channel : table_.channels) {
      std::vector<double>& values = values_of(channel);
      values.insert(values.begin(), 0.0);
    }
  }

  LineReader lines_;
  const config::UnitConfig& unit_;
  char delimiter_ = ',';
  std::vector<Cell> cells_;
  enum class UnitOf { kCv, kInput };
  std::array<UnitOf, 2> unit_columns_{};
  std::size_t coefficients_ = kTags;  // cells before them
  std::set<std::string> untold_;      // tags whose unit could not be compared
  std::optional<int> begins_at_;      // samples after the step
  std::size_t width_ = 0;             // cells of a row; 0 = not known yet
  int width_line_ = 0;
  std::map<std::pair<int, int>, int> rows_;
  StepTable table_;
};

}  // namespace

StepTable read_step_table(const std::string& path, const config::UnitConfig& unit) {
  return TableReader(path, unit).read();
}

}  // namespace mpm::files
