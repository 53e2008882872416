#include "daemon/files/csv/averaged_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"

namespace mpm::files {
namespace {

constexpr double kJitter = 0.1;      // of the time between two rows, that a row may come too early
constexpr double kOldest = 0.5;      // intervals, of what was measured
constexpr double kSameMoment = 0.5;  // of the time between two rows
constexpr std::size_t kFewestMoves = 3;

/// Acts from its row's time on, rather than being measured then.
bool acts(SignalKind kind) {
  return kind == SignalKind::kMv || kind == SignalKind::kDv || kind == SignalKind::kAux;
}

template <class Means>
void clear(Means& means) {
  for (auto& kind : means)
    std::fill(kind.begin(), kind.end(), typename Means::value_type::value_type());
}

}  // namespace

void AveragedRows::Mean::add(double value, Quality of_value) {
  if (!std::isfinite(value) || of_value > Quality::kUncertain || of_value > quality) return;
  if (of_value < quality) *this = {.quality = of_value};  // better than all before
  sum += value;
  ++count;
}

AveragedRows::AveragedRows(std::unique_ptr<RowSource> rows, std::deque<Frame> read,
                           std::int64_t begin_ns, double step_s, double sample_time_s,
                           std::vector<std::string>& notices)
    : rows_(std::move(rows)),
      read_(std::move(read)),
      notices_(notices),
      begin_ns_(begin_ns),
      sample_time_ns_(sample_time_s * kNsPerSecond),
      jitter_(kJitter * step_s / sample_time_s) {
  for (std::size_t k = 0; k < kSignalKindCount; ++k)
    now_[k].resize(static_cast<std::size_t>(read_.front().blocks[k].size()));
  next_ = now_;
}

bool AveragedRows::next(Frame& frame) {
  Frame row;
  bool any = false;
  while (ahead_ || read_row(row)) {
    if (ahead_) row = std::move(*std::exchange(ahead_, std::nullopt));
    const double at = elapsed(row);
    const auto interval = static_cast<std::int64_t>(std::floor(at + jitter_));
    if (any && interval == at_ - 1) {
      ++left_out_;
      continue;
    }
    if (interval != at_) {
      if (any) {
        give(frame);
        ahead_ = std::move(row);
        return true;
      }
      if (interval == at_ + 1)
        std::swap(now_, next_);
      else
        clear(now_);
      clear(next_);
      at_ = interval;
    }
    take(row, at);
    any = true;
  }
  if (any) {
    give(frame);
    return true;
  }
  if (left_out_ > 0)
    notices_.push_back(counted(left_out_, "row") + " left out, for the time goes back");
  left_out_ = 0;
  return false;
}

bool AveragedRows::read_row(Frame& row) {
  if (read_.empty()) return rows_->next(row);
  row = std::move(read_.front());
  read_.pop_front();
  return true;
}

double AveragedRows::elapsed(const Frame& row) const {
  return static_cast<double>(row.source_time_ns - begin_ns_) / sample_time_ns_;
}

void AveragedRows::take(const Frame& row, double elapsed) {
  // What is measured at the very beginning of an interval belongs to the one that ends there.
  const double since = elapsed - static_cast<double>(at_);
  const bool at_beginning = since <= jitter_;
  const bool too_old = !at_beginning && 1.0 - since > kOldest + jitter_;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    const SignalBlock& block = row.blocks[k];
    const bool input = acts(static_cast<SignalKind>(k));
    if (!input && too_old) continue;
    std::vector<Mean>& means = input || at_beginning ? now_[k] : next_[k];
    for (int i = 0; i < block.size(); ++i) {
      const auto place = static_cast<std::size_t>(i);
      Mean one;
      one.add(block.values(i), block.quality[place]);
      if (input)
        means[place].add(block.values(i), block.quality[place]);
      else if (one.count > 0 && one.quality <= means[place].quality)
        means[place] = one;
    }
  }
}

void AveragedRows::give(Frame& frame) const {
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    SignalBlock& block = frame.blocks[k];
    block.resize(static_cast<int>(now_[k].size()));
    for (int i = 0; i < block.size(); ++i) {
      const Mean& mean = now_[k][static_cast<std::size_t>(i)];
      block.values(i) =
          mean.count > 0 ? mean.sum / mean.count : std::numeric_limits<double>::quiet_NaN();
      block.quality[static_cast<std::size_t>(i)] = mean.quality;
    }
  }
  frame.source_time_ns = begin_ns_ + std::llround(static_cast<double>(at_) * sample_time_ns_);
}

std::optional<std::int64_t> moves_at(const std::deque<Frame>& rows, double step_s,
                                     double sample_time_s) {
  std::optional<std::int64_t> begin_ns;
  std::size_t moves = 0;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const SignalBlock& before = rows[r - 1][SignalKind::kMv];
    const SignalBlock& after = rows[r][SignalKind::kMv];
    bool moved = false;
    for (int i = 0; i < after.size(); ++i)
      moved = moved || (before.usable(i) && after.usable(i) && before.values(i) != after.values(i));
    if (!moved) continue;
    const std::int64_t time_ns = rows[r].source_time_ns;
    if (!begin_ns) begin_ns = time_ns;
    const double apart = static_cast<double>(time_ns - *begin_ns) / (sample_time_s * kNsPerSecond);
    if (std::abs(apart - std::round(apart)) > kSameMoment * step_s / sample_time_s)
      return std::nullopt;
    ++moves;
  }
  return moves >= kFewestMoves ? begin_ns : std::nullopt;
}

}  // namespace mpm::files
