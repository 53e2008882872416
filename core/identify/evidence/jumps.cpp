#include "core/identify/evidence/jumps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/identify/fit/runs.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Enough for the screen to know a signal.
constexpr Index kMirrored = 2 * calibration::extent::kFirstValues;
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

void leave_out(const SignalBlock& judged, Index row, MatrixXd& values,
               std::vector<Index>& left_out) {
  for (int i = 0; i < judged.size(); ++i) {
    if (judged.quality[static_cast<std::size_t>(i)] != Quality::kImplausible) continue;
    values(row, i) = std::numeric_limits<double>::quiet_NaN();
    ++left_out[static_cast<std::size_t>(i)];
  }
}

}  // namespace

Index JumpTally::total() const {
  return std::accumulate(inputs.begin(), inputs.end(), Index{0}) +
         std::accumulate(cvs.begin(), cvs.end(), Index{0});
}

void JumpTally::add(const JumpTally& other) {
  const auto sum = [](std::vector<Index>& mine, const std::vector<Index>& others) {
    mine.resize(std::max(mine.size(), others.size()), 0);
    for (std::size_t i = 0; i < others.size(); ++i) mine[i] += others[i];
  };
  sum(inputs, other.inputs);
  sum(cvs, other.cvs);
}

JumpTally leave_out_jumps(Recording& recording) {
  const SignalCounts counts = counts_of(recording);
  JumpTally left_out{std::vector<Index>(static_cast<std::size_t>(counts.mv), 0),
                     std::vector<Index>(static_cast<std::size_t>(counts.cv), 0)};
  Frame frame(counts);
  for (const Run& run : runs_of(recording)) {
    Screen screen(counts, Screen::Looks::kFar);
    const auto look = [&] {
      while (const Frame* judged = screen.next()) {
        const auto row = static_cast<Index>(judged->interval);
        if (judged->interval == kNoRow) continue;
        leave_out((*judged)[SignalKind::kMv], row, recording.inputs, left_out.inputs);
        leave_out((*judged)[SignalKind::kCv], row, recording.cvs, left_out.cvs);
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
  return left_out;
}

}  // namespace mpm
