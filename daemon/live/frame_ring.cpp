#include "daemon/live/frame_ring.hpp"

#include <algorithm>
#include <limits>

#include "core/archive/archive.hpp"

namespace mpm::live {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

int width_of(const SignalCounts& counts) { return counts.inputs() + counts.cv; }

}  // namespace

Eigen::Index RingCopy::rows() const {
  return static_cast<Eigen::Index>(values.size()) / width_of(counts);
}

Recording RingCopy::recording(double sample_time_s) const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> all(values.data(), rows(), width_of(counts));
  Recording recording;
  recording.sample_time_s = sample_time_s;
  recording.start_s = static_cast<double>(last_time_ns) * 1e-9 -
                      static_cast<double>(std::max<Eigen::Index>(0, rows() - 1)) * sample_time_s;
  recording.inputs = all.leftCols(counts.inputs());
  recording.cvs = all.rightCols(counts.cv);
  recording.aux.resize(rows(), 0);  // aux signals are in files only
  return recording;
}

FrameRing::FrameRing(const SignalCounts& counts, int capacity)
    : counts_(counts),
      width_(width_of(counts)),
      capacity_(capacity),
      values_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(capacity), kUnknown) {}

double* FrameRing::next_row() {
  double* row = values_.data() + static_cast<std::ptrdiff_t>(next_) * width_;
  next_ = next_ + 1 == capacity_ ? 0 : next_ + 1;
  rows_ = std::min(rows_ + 1, capacity_);
  return row;
}

void FrameRing::push(const Frame& frame) {
  if (rows_ > 0) {
    if (frame.interval <= last_interval_) return;
    const std::int64_t missing = frame.interval - last_interval_ - 1;
    if (missing >= capacity_) rows_ = next_ = 0;  // nothing that is left would be of use
    for (std::int64_t i = 0; rows_ > 0 && i < missing; ++i)
      std::fill_n(next_row(), width_, kUnknown);
  }
  last_interval_ = frame.interval;
  last_time_ns_ = frame.source_time_ns;
  double* value = next_row();
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv}) {
    const SignalBlock& block = frame[kind];
    for (int i = 0; i < block.size(); ++i) *value++ = block.usable(i) ? block.values(i) : kUnknown;
  }
}

void FrameRing::archive(Archive& a) {
  // not archived: counts_, width_, capacity_ (construction)
  a.within(rows_, 0, capacity_);
  a.within(next_, 0, capacity_ - 1);
  a.require(rows_ == capacity_ || rows_ == next_, "a ring with a hole");
  a(last_interval_);
  a.time(last_time_ns_);
  a.length(static_cast<std::size_t>(width_));
  a.doubles(values_.data(), static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows_));
}

RingCopy FrameRing::copy() const {
  RingCopy copy;
  copy.counts = counts_;
  copy.last_interval = last_interval_;
  copy.last_time_ns = last_time_ns_;
  const auto at = [this](int row) {
    return values_.begin() + static_cast<std::ptrdiff_t>(row) * width_;
  };
  copy.values.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(width_));
  if (rows_ == capacity_) copy.values.insert(copy.values.end(), at(next_), values_.end());
  copy.values.insert(copy.values.end(), values_.begin(), at(next_));
  return copy;
}

}  // namespace mpm::live
