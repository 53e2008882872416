#include "daemon/files/csv/state_space_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "config/finding.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/csv_line.hpp"

namespace mpm::files {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Tags = std::vector<std::string>;

constexpr Index kMostStates = 500;
constexpr double kSameSampleTime = 1e-6;  // relative

std::string shape(Index rows, Index cols) {
  return std::to_string(rows) + " x " + std::to_string(cols);
}

/// One matrix and the tags that stand around it.
class MatrixReader {
 public:
  /// `columns`, `rows`: tags that may stand there; empty = none may.
  MatrixReader(const std::string& path, Tags columns, Tags rows)
      : lines_(open_file(path), path), columns_(std::move(columns)), rows_(std::move(rows)) {}

  MatrixXd read() {
    if (!lines_.next()) lines_.fail(1, 1, "holds nothing");
    delimiter_ = find_delimiter(lines_.text());
    lines_.split(delimiter_, cells_);
    bool more = true;
    if (!columns_.empty() && !number(cells_.back())) {
      check_heading();
      more = lines_.next();
    }
    for (; more; more = lines_.next()) read_row();
    if (values_.empty()) lines_.fail(lines_.number(), 1, "holds no numbers");
    MatrixXd matrix(static_cast<Index>(values_.size()), static_cast<Index>(values_[0].size()));
    for (std::size_t i = 0; i < values_.size(); ++i)
      for (std::size_t j = 0; j < values_[i].size(); ++j)
        matrix(static_cast<Index>(i), static_cast<Index>(j)) = values_[i][j];
    return matrix;
  }

 private:
  [[nodiscard]] std::optional<double> number(const Cell& cell) const {
    const std::optional<double> value = parse_value(cell.text, delimiter_ != ',');
    return value && std::isfinite(*value) ? value : std::nullopt;
  }

  void check_tag(const Cell& cell, const Tags& tags, std::size_t place) const {
    if (place >= tags.size())
      lines_.fail(cell.column, "the unit has " + counted(tags.size(), "signal") + " here");
    if (cell.text != tags[place])
      lines_.fail(cell.column, "'" + printable(std::string(cell.text)) +
                                   "' stands where the unit file has '" + tags[place] + "'");
  }

  void check_heading() const {
    const std::size_t first = cells_.size() > columns_.size() ? 1 : 0;  // above the rows' tags
    for (std::size_t i = first; i < cells_.size(); ++i) check_tag(cells_[i], columns_, i - first);
  }

  void read_row() {
    lines_.split(delimiter_, cells_);
    const std::size_t first = !rows_.empty() && !number(cells_[0]) ? 1 : 0;
    if (first == 1) check_tag(cells_[0], rows_, values_.size());
    std::vector<double> row;
    for (std::size_t i = first; i < cells_.size(); ++i) {
      const std::optional<double> value = number(cells_[i]);
      if (!value)
        lines_.fail(cells_[i].column,
                    "'" + printable(std::string(cells_[i].text)) + "' is no number");
      row.push_back(*value);
    }
    if (!values_.empty() && row.size() != values_[0].size())
      lines_.fail(1, "this row has " + counted(row.size(), "number") + ", the first one " +
                         std::to_string(values_[0].size()));
    values_.push_back(std::move(row));
  }

  LineReader lines_;
  Tags columns_, rows_;
  char delimiter_ = ',';
  std::vector<Cell> cells_;
  std::vector<std::vector<double>> values_;
};

[[noreturn]] void refuse(const std::string& path, int line, const std::string& message) {
  throw config::InputError({path, line, line, config::Severity::kError, "", message});
}

void check_shape(const std::string& path, const MatrixXd& matrix, Index rows, Index cols,
                 const char* why) {
  if (matrix.rows() != rows || matrix.cols() != cols)
    refuse(path, 0,
           "must be " + shape(rows, cols) + " (" + why + "), not " +
               shape(matrix.rows(), matrix.cols()));
}

void check_sample_time(const std::string& path, const config::UnitConfig& unit) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::size_t colon = line.find(':');
  if (!line.starts_with('#') || colon == std::string::npos) return;
  const std::size_t name = line.find_first_not_of("# ");
  if (name == std::string::npos || !line.substr(name).starts_with("sample_time")) return;
  const std::size_t begin = std::min(line.find_first_not_of(' ', colon + 1), line.size());
  const std::size_t end = std::min(line.find_last_not_of(" s\r") + 1, line.size());
  const std::optional<double> sample_time_s =
      begin < end ? parse_value(line.substr(begin, end - begin), true) : std::nullopt;
  if (!sample_time_s ||
      !(std::abs(*sample_time_s - unit.sample_time_s) <= kSameSampleTime * unit.sample_time_s))
    refuse(path, 1, "the unit's sample_time is " + number_text(unit.sample_time_s) + " s");
}

}  // namespace

StateSpaceSpec read_state_space_folder(const std::string& folder, const config::UnitConfig& unit) {
  const auto path = [&folder](const char* name) {
    return (std::filesystem::path(folder) / (std::string(name) + ".csv")).string();
  };
  const auto there = [&](const char* name) { return std::filesystem::exists(path(name)); };
  const Tags inputs = unit.input_tags(), cvs = unit.cv_tags();
  const auto input_count = static_cast<Index>(inputs.size());
  const auto cv_count = static_cast<Index>(cvs.size());
  StateSpaceSpec system;
  system.a = MatrixReader(path("A"), {}, {}).read();
  const Index states = system.a.rows();
  check_sample_time(path("A"), unit);
  if (states > kMostStates)
    refuse(path("A"), 0, "must have at most " + std::to_string(kMostStates) + " rows");
  check_shape(path("A"), system.a, states, states, "square");
  system.b = MatrixReader(path("B"), inputs, {}).read();
  check_shape(path("B"), system.b, states, input_count, "states x MVs and DVs");
  system.c = MatrixReader(path("C"), {}, cvs).read();
  check_shape(path("C"), system.c, cv_count, states, "CVs x states");
  system.d = MatrixXd::Zero(cv_count, input_count);
  if (there("D")) {
    system.d = MatrixReader(path("D"), inputs, cvs).read();
    check_shape(path("D"), system.d, cv_count, input_count, "CVs x MVs and DVs");
  }
  if (there("x0")) {
    const MatrixXd start = MatrixReader(path("x0"), {}, {}).read();
    if (start.size() != states || (start.rows() != 1 && start.cols() != 1))
      refuse(
          path("x0"), 0,
          "must be " + counted(static_cast<std::uint64_t>(states), "number") + ", one per state");
    system.x0 = start.reshaped();
  }
  return system;
}

}  // namespace mpm::files
