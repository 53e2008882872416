#include "daemon/files/read_recording.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <vector>

#include "config/finding.hpp"
#include "config/unit_layout.hpp"
#include "core/identify/fit/runs.hpp"
#include "core/text/number_text.hpp"

namespace mpm::files {
namespace {

// 640 MB as doubles: three months of seconds at 10 tags.
constexpr std::int64_t kMostValues = 80'000'000;

// Share of an input's values.
constexpr double kLeastKnown = 0.5;

// Less movement than this share of its level is rounding, not a move.
constexpr double kStill = 1e-9;

/// Rows one after the other; frames do not tell how many will come, so they are kept in blocks,
/// none of which ever has to be moved.
class Table {
 public:
  explicit Table(const SignalCounts& counts)
      : counts_(counts), width_(counts.inputs() + 2 * counts.cv + counts.aux) {
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv})
      unusable_[static_cast<std::size_t>(kind)].resize(static_cast<std::size_t>(counts.of(kind)));
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] std::int64_t rows() const { return rows_; }
  void skip_to(std::int64_t row) {
    while (rows_ < row) next_row().setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  void add(const Frame& frame) {
    Block::RowXpr row = next_row();
    Eigen::Index column = 0;
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                  SignalKind::kAux, SignalKind::kSetpoint}) {
      const SignalBlock& block = frame[kind];
      for (int i = 0; i < block.size(); ++i) {
        const bool usable = block.usable(i);
        row(column++) = usable ? block.values(i) : std::numeric_limits<double>::quiet_NaN();
        const bool needed = kind != SignalKind::kAux && kind != SignalKind::kSetpoint;
        if (!usable && needed)
          ++unusable_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
      }
    }
  }
  /// Values of inputs and CVs.
  [[nodiscard]] const config::SignalTally& unusable() const { return unusable_; }
  /// Block by block, each of which is given back then: the table is empty afterwards.
  void move_to(Recording& recording) {
    recording.inputs.resize(rows_, counts_.inputs());
    recording.cvs.resize(rows_, counts_.cv);
    recording.aux.resize(rows_, counts_.aux);
    recording.setpoints.resize(rows_, counts_.cv);
    for (std::int64_t first = 0; first < rows_; first += kBlockRows, blocks_.pop_front()) {
      const std::int64_t count = std::min(kBlockRows, rows_ - first);
      Eigen::Index column = 0;
      for (Eigen::MatrixXd* part :
           {&recording.inputs, &recording.cvs, &recording.aux, &recording.setpoints}) {
        part->middleRows(first, count) = blocks_.front().block(0, column, count, part->cols());
        column += part->cols();
      }
    }
    rows_ = 0;
  }

 private:
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr std::int64_t kBlockRows = 4096;

  Block::RowXpr next_row() {
    if (rows_ % kBlockRows == 0) blocks_.emplace_back(kBlockRows, width_);
    return blocks_.back().row(rows_++ % kBlockRows);
  }

  SignalCounts counts_;
  config::SignalTally unusable_;
  int width_;
  std::int64_t rows_ = 0;
  std::deque<Block> blocks_;
};

std::string seconds_text(double seconds) {
  std::string text = std::to_string(seconds);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

bool moves(const Eigen::Ref<const Eigen::VectorXd>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high - low > kStill * std::max(std::abs(low), std::abs(high));
}

}  // namespace

void leave_out_unusable(RecordingFile& file) {
  Recording& recording = file.recording;
  file.jumps = leave_out_jumps(recording);
  const Eigen::Index all = recording.samples();
  recording = without_lost_inputs(std::move(recording));
  const Eigen::Index rows = recording.samples();
  file.lost = all - rows;
  if (!recording.borders.empty()) recording = without_scraps(recording);
  file.scraps = rows - recording.samples();
}

RecordingFile read_recording(FrameSource& source, const config::UnitConfig& unit,
                             const std::string& name, const TimeChoice& choice) {
  const auto refuse = [&name](const std::string& message) {
    throw config::InputError({name, 0, 0, config::Severity::kError, "", message});
  };
  RecordingFile file;
  Recording& recording = file.recording;
  recording.sample_time_s = unit.sample_time_s;
  file.longest_gap = longest_gap(unit.model);
  Table table(unit.counts());
  const std::int64_t most_rows = kMostValues / table.width();
  std::int64_t first = 0, next = 0;  // intervals: of the first row, and after the last from there
  std::int64_t first_ns = 0, last_ns = 0, left_out = 0;
  bool cut = false;  // since the last row
  Frame frame(unit.counts());
  while (source.next(frame)) {
    if (table.rows() + left_out == 0) first_ns = frame.source_time_ns;
    last_ns = frame.source_time_ns;
    if (!choice.takes(frame.source_time_ns)) {
      ++left_out;
      cut = true;
      continue;
    }
    const double time_s = static_cast<double>(frame.source_time_ns) * 1e-9;
    if (table.rows() == 0) {
      first = frame.interval;
      recording.start_s = time_s;
      cut = false;
    }
    const std::int64_t row = frame.interval - first, gap = row - next;
    if (gap < 0) {
      ++file.out_of_order;
      continue;
    }
    if (row >= most_rows)
      refuse("spans more than the " + std::to_string(most_rows) +
             " control intervals that a diagnosis of this unit takes (from row " +
             std::to_string(table.rows() - file.missing) + " on it is " +
             seconds_text(static_cast<double>(gap) * unit.sample_time_s) + " later); cut the file");
    if (cut || gap > file.longest_gap) {
      const double by_rows_s =
          recording.start_s + static_cast<double>(table.rows()) * unit.sample_time_s;
      recording.borders.push_back({table.rows(), time_s - by_rows_s});
      file.long_gaps += cut ? 0 : 1;
      cut = false;
    } else {
      file.missing += gap;
      table.skip_to(table.rows() + gap);
    }
    table.add(frame);
    next = row + 1;
  }
  if (table.rows() == 0 && left_out > 0) refuse(nothing_chosen(first_ns, last_ns));
  file.bad_tags = config::by_tag(unit, table.unusable());
  for (const auto& [tag, bad] : file.bad_tags) file.bad_values += static_cast<std::int64_t>(bad);
  table.move_to(recording);
  leave_out_unusable(file);
  return file;
}

std::string recording_problem(const Recording& recording, const config::UnitConfig& unit,
                              Eigen::Index needed) {
  const auto usable = [](const Eigen::MatrixXd& block, Eigen::Index row) {
    return block.row(row).array().isFinite().any();
  };
  Eigen::Index rows = 0;
  for (Eigen::Index row = 0; row < recording.samples(); ++row)
    if (usable(recording.cvs, row) && usable(recording.inputs, row)) ++rows;
  if (rows < needed)
    return "too short: " + counted(static_cast<std::uint64_t>(rows), "usable sample") +
           ", a diagnosis of this model needs " + std::to_string(needed) + " (" +
           seconds_text(static_cast<double>(needed) * recording.sample_time_s) + ")";
  for (Eigen::Index i = 0; i < recording.inputs.cols(); ++i) {
    const double known = static_cast<double>(recording.inputs.col(i).array().isFinite().count()) /
                         static_cast<double>(recording.samples());
    const bool acts = unit.model.state_space ||
                      std::any_of(unit.model.channels.begin(), unit.model.channels.end(),
                                  [i](const ChannelSpec& channel) {
                                    return channel.input == static_cast<int>(i);
                                  });
    if (acts && known < kLeastKnown)
      return unit.input_tag(static_cast<int>(i)) + " has no usable value in " +
             percent_text(1.0 - known) +
             " of the samples: without it the model cannot be simulated";
  }
  for (Eigen::Index i = 0; i < recording.inputs.cols(); ++i)
    if (moves(recording.inputs.col(i))) return {};
  return "no excitation: no MV or DV of the model moves, so nothing can be told about it";
}

}  // namespace mpm::files
