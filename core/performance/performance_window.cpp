#include "core/performance/performance_window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/archive/archive.hpp"

namespace mpm {

using calibration::performance::kBlocks;
using calibration::performance::kFewestSamples;
using calibration::performance::kMostSamples;

PerformanceWindow::PerformanceWindow(PerformanceSetup setup, double samples)
    : frames_(setup.counts),
      meter_(std::move(setup)),
      block_samples_(static_cast<std::int64_t>(std::ceil(
          std::clamp(samples, static_cast<double>(kFewestSamples), kMostSamples) / kBlocks))),
      blocks_(kBlocks, PerformanceSums(meter_.setup())),
      total_(meter_.setup()) {}

std::int64_t PerformanceWindow::samples() const { return kBlocks * block_samples_; }

bool PerformanceWindow::push(const Frame& frame, std::span<const JudgedFrame> judged) {
  if (!frames_.push(frame)) return false;
  if (frames_.anew()) {
    meter_.begin_run();
    for (PerformanceSums& block : blocks_) block.clear();
  }
  bool ended = false;
  while (const Frame* plausible = frames_.next()) ended = take(*plausible) || ended;
  PerformanceSums& sums = blocks_[static_cast<std::size_t>(block_ % kBlocks)];
  for (const JudgedFrame& one : judged) meter_.judge(one, sums);
  return ended;
}

bool PerformanceWindow::take(const Frame& frame) {
  if (!begun_) first_ = frame.interval;
  begun_ = true;
  last_ = frame.interval;
  const std::int64_t since = last_ - first_, block = since / block_samples_;
  const bool ended = open_ && block != block_;
  slide_to(block);
  meter_.take(frame, blocks_[static_cast<std::size_t>(block % kBlocks)]);
  open_ = (since + 1) % block_samples_ != 0;
  return ended || !open_;
}

void PerformanceWindow::archive(Archive& a) {
  // not archived: block_samples_ (construction)
  // not archived: total_ (added up whenever it is asked for)
  a(frames_, meter_, blocks_, first_, block_, last_, begun_, open_);
  a.require(first_ <= last_ && block_ == (last_ - first_) / block_samples_,
            "a window of other intervals");
}

void PerformanceWindow::slide_to(std::int64_t block) {
  const std::int64_t steps = std::min<std::int64_t>(block - block_, kBlocks);
  for (std::int64_t k = 0; k < steps; ++k)
    blocks_[static_cast<std::size_t>((block - k) % kBlocks)].clear();
  block_ = block;
}

const PerformanceSums& PerformanceWindow::total() {
  total_.clear();
  // From the oldest on, so that the sums are those of one who adds as time goes by.
  for (std::int64_t k = kBlocks - 1; k >= 0; --k)
    if (k <= block_) total_.add(blocks_[static_cast<std::size_t>((block_ - k) % kBlocks)]);
  return total_;
}

}  // namespace mpm
