#include "core/identify/evidence/jumps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/identify/evidence/calibration.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr std::int64_t kNoRow = -1;

SignalCounts counts_of(const Recording& recording) {
  SignalCounts counts;
  counts.mv = static_cast<int>(recording.inputs.cols());
  counts.cv = static_cast<int>(recording.cvs.cols());
  return counts;
}

void take(const MatrixXd& values, Index row, SignalBlock& block) {
  for (int i = 0; i < block.size(); ++i) {
    const double value = values(row, i);
    const bool known = std::isfinite(value);
    block.values(i) = known ? value : 0.0;
    block.quality[static_cast<std::size_t>(i)] = known ? Quality::kGood : Quality::kBad;
  }
}

/// Per signal: the rows that the screen has marked, ascending.
using Marks = std::vector<std::vector<Index>>;

void note(const SignalBlock& judged, Index row, Marks& marks) {
  for (int i = 0; i < judged.size(); ++i)
    if (judged.quality[static_cast<std::size_t>(i)] == Quality::kImplausible)
      marks[static_cast<std::size_t>(i)].push_back(row);
}

struct Extremes {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

Extremes extremes_without(const Eigen::Ref<const Eigen::VectorXd>& values,
                          const std::vector<Index>& marked) {
  Extremes all;
  auto mark = marked.begin();
  for (Index k = 0; k < values.size(); ++k) {
    if (mark != marked.end() && *mark == k) {
      ++mark;
    } else if (std::isfinite(values(k))) {
      all.low = std::min(all.low, values(k));
      all.high = std::max(all.high, values(k));
    }
  }
  return all;
}

/// How many. A test pulse lasts longer than what an instrument makes up, but where no process goes;
/// and of a signal that otherwise stands still it is all that there is.
Index leave_out(const std::vector<Index>& marked, Eigen::Ref<Eigen::VectorXd> values) {
  const auto [low, high] = extremes_without(values, marked);
  if (!(high > low)) return 0;
  const double farthest = calibration::extent::kTooFar * (high - low);
  Index count = 0;
  for (std::size_t first = 0, next = 0; first < marked.size(); first = next) {
    bool absurd = true;
    for (next = first;
         next < marked.size() && marked[next] == marked[first] + static_cast<Index>(next - first);
         ++next)
      absurd =
          absurd && std::max(low - values(marked[next]), values(marked[next]) - high) > farthest;
    if (next - first > std::size_t{kLongestGlitch} && !absurd) continue;
    for (std::size_t k = first; k < next; ++k, ++count)
      values(marked[k]) = std::numeric_limits<double>::quiet_NaN();
  }
  return count;
}

/// In hindsight, whatever it lasts: what few rows have that lies a hundred thousand times the range
/// of most others away is another unit's, or nobody's. How many.
Index leave_out_elsewhere(Eigen::Ref<Eigen::VectorXd> values) {
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  if (known.empty()) return 0;
  const auto quantile = [&](double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(known.size() - 1));
    std::nth_element(known.begin(), known.begin() + at, known.end());
    return known[static_cast<std::size_t>(at)];
  };
  const double low = quantile(kFewRows), high = quantile(1.0 - kFewRows);
  const double farthest = kElsewhere * (high - low);
  const auto elsewhere = [&](double value) {
    return low - value > farthest || value - high > farthest;
  };
  if (!(high > low)) return 0;
  Index count = 0;
  for (double& value : values)
    if (std::isfinite(value) && elsewhere(value)) {
      value = std::numeric_limits<double>::quiet_NaN();
      ++count;
    }
  return count;
}

}  // namespace

Index JumpTally::total() const {
  return std::accumulate(inputs.begin(), inputs.end(), Index{0}) +
         std::accumulate(cvs.begin(), cvs.end(), Index{0});
}

JumpTally leave_out_jumps(Recording& recording) {
  const SignalCounts counts = counts_of(recording);
  Marks inputs(static_cast<std::size_t>(counts.mv)), cvs(static_cast<std::size_t>(counts.cv));
  JumpTally left_out;
  for (auto&& input : recording.inputs.colwise())
    left_out.inputs.push_back(leave_out_elsewhere(input));
  for (auto&& cv : recording.cvs.colwise()) left_out.cvs.push_back(leave_out_elsewhere(cv));
  Frame frame(counts);
  for (const Run& run : runs_of(recording)) {
    Screen screen(counts, Screen::Looks::kFar);
    const auto look = [&] {
      while (const Frame* judged = screen.next()) {
        const auto row = static_cast<Index>(judged->interval);
        if (judged->interval == kNoRow) continue;
        note((*judged)[SignalKind::kMv], row, inputs);
        note((*judged)[SignalKind::kCv], row, cvs);
      }
    };
    const auto push = [&](Index k, std::int64_t interval) {
      frame.interval = interval;
      take(recording.inputs, run.first + k, frame[SignalKind::kMv]);
      take(recording.cvs, run.first + k, frame[SignalKind::kCv]);
      screen.push(frame);
      look();
    };
    // What the first rows and the last are judged by, of which nothing more is known: as it came,
    // so it goes.
    const Index mirrored = std::min(kMirrored, run.count - 1);
    for (Index k = mirrored; k > 0; --k) push(k, kNoRow);
    for (Index k = 0; k < run.count; ++k) push(k, run.first + k);
    for (Index k = 1; k <= mirrored; ++k) push(run.count - 1 - k, kNoRow);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i)
    left_out.inputs[i] += leave_out(inputs[i], recording.inputs.col(static_cast<Index>(i)));
  for (std::size_t j = 0; j < cvs.size(); ++j)
    left_out.cvs[j] += leave_out(cvs[j], recording.cvs.col(static_cast<Index>(j)));
  return left_out;
}

}  // namespace mpm
