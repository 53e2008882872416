#include "daemon/files/csv/step_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "config/suggest.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/csv_line.hpp"

namespace mpm::files {
namespace {

constexpr std::size_t kPlaces = 2;             // cells before the coefficients
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
    return cells_.size() >= kPlaces && same_word(cells_[0].text, "cv") &&
           (same_word(cells_[1].text, "mv") || same_word(cells_[1].text, "dv") ||
            same_word(cells_[1].text, "input"));
  }

  [[nodiscard]] std::optional<double> number(const Cell& cell) const {
    const std::optional<double> value = parse_value(cell.text, delimiter_ != ',');
    return value && std::isfinite(*value) ? value : std::nullopt;
  }

  /// Words above the coefficients are names; numbers are times.
  void read_header() {
    if (cells_.size() == kPlaces || !number(cells_[kPlaces])) return;
    std::vector<double> times_s;
    for (std::size_t i = kPlaces; i < cells_.size(); ++i) {
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
        lines_.fail(cells_[kPlaces + i].column, "should be " + number_text(expected * sample_s) +
                                                    " s: the unit's sample_time is " +
                                                    number_text(sample_s) + " s");
    }
    width_ = cells_.size();
    width_line_ = lines_.number();
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
    if (cells_.size() <= kPlaces)
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
                  "this row has " + counted(cells_.size() - kPlaces, "coefficient") + ", line " +
                      std::to_string(width_line_) + " has " + std::to_string(width_ - kPlaces));
    StepResponse response;
    for (std::size_t i = kPlaces; i < cells_.size(); ++i) {
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
  std::optional<int> begins_at_;  // samples after the step
  std::size_t width_ = 0;         // cells of a row; 0 = not known yet
  int width_line_ = 0;
  std::map<std::pair<int, int>, int> rows_;
  StepTable table_;
};

}  // namespace

StepTable read_step_table(const std::string& path, const config::UnitConfig& unit) {
  return TableReader(path, unit).read();
}

}  // namespace mpm::files
