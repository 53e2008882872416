#include "daemon/http/history.hpp"

#include <algorithm>
#include <cmath>

#include "core/signal/nanoseconds.hpp"

namespace mpm::http {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
// Of what an entry stands for: after a longer silence a line is broken.
constexpr double kGap = 3.0;
constexpr std::size_t kParts = 3;  // of a Reach
// The coarsest buckets of longer steps would be too long for whole ns.
constexpr double kLongestStep = 1e6;  // s

/// Entries put together to those that are drawn.
class Bins {
 public:
  Bins(std::int64_t from_ns, std::int64_t until_ns, std::size_t points, std::size_t columns)
      : from_ns_(from_ns),
        width_ns_(std::max(1.0, static_cast<double>(until_ns - from_ns) /
                                    static_cast<double>(std::max<std::size_t>(1, points)))),
        sums_(columns) {}

  void begin(std::int64_t time_ns, std::int64_t span_ns, double weight, Drawing& drawing) {
    const auto index =
        static_cast<std::int64_t>(static_cast<double>(time_ns - from_ns_) / width_ns_);
    if (open_ && index != index_) close(drawing);
    open_ = true;
    index_ = index;
    span_ns_ = std::max(span_ns_, span_ns);
    time_ += weight * static_cast<double>(time_ns);
    weight_ += weight;
    entry_weight_ = weight;
  }
  void add(std::size_t column, Reach reach) {
    if (std::isnan(reach.mean)) return;
    Sum& sum = sums_[column];
    sum.low = std::isnan(sum.low) ? reach.low : std::min(sum.low, reach.low);
    sum.high = std::isnan(sum.high) ? reach.high : std::max(sum.high, reach.high);
    sum.sum += entry_weight_ * static_cast<double>(reach.mean);
    sum.weight += entry_weight_;
  }
  void close(Drawing& drawing) {
    if (!open_) return;
    const double time_s = time_ / weight_ / kNsPerSecond;
    const double spacing = std::max(width_ns_, static_cast<double>(span_ns_)) / kNsPerSecond;
    if (!drawing.times_s.empty() && time_s - drawing.times_s.back() > kGap * spacing) {
      drawing.times_s.push_back(0.5 * (time_s + drawing.times_s.back()));
      for (auto& column : drawing.reaches) column.emplace_back();
    }
    drawing.times_s.push_back(time_s);
    for (std::size_t c = 0; c < sums_.size(); ++c) {
      const Sum& sum = sums_[c];
      drawing.reaches[c].push_back(
          sum.weight > 0.0 ? Reach{sum.low, static_cast<float>(sum.sum / sum.weight), sum.high}
                           : Reach{});
      sums_[c] = {};
    }
    open_ = false;
    time_ = weight_ = 0.0;
    span_ns_ = 0;
  }

 private:
  struct Sum {
    float low = kUnknown, high = kUnknown;
    double sum = 0.0, weight = 0.0;
  };
  std::int64_t from_ns_;
  double width_ns_;
  std::vector<Sum> sums_;
  bool open_ = false;
  std::int64_t index_ = 0, span_ns_ = 0;
  double time_ = 0.0, weight_ = 0.0, entry_weight_ = 0.0;
};

}  // namespace

RowRing::RowRing(int width, std::size_t capacity)
    : width_(static_cast<std::size_t>(width)), capacity_(capacity) {}

void RowRing::push(std::int64_t time_ns, std::span<const float> row) {
  if (count_ == capacity_) {
    first_ = slot(1);
    --count_;
    full_ = true;
  }
  const std::size_t place = slot(count_++);
  if (place == times_.size()) {
    times_.push_back(time_ns);
    values_.insert(values_.end(), row.begin(), row.end());
    return;
  }
  times_[place] = time_ns;
  std::copy(row.begin(), row.end(), values_.begin() + static_cast<std::ptrdiff_t>(place * width_));
}

void RowRing::pop() { --count_; }

std::span<float> RowRing::row(std::size_t index) {
  return {values_.data() + slot(index) * width_, width_};
}

std::span<const float> RowRing::row(std::size_t index) const {
  return {values_.data() + slot(index) * width_, width_};
}

std::size_t RowRing::bytes() const {
  return times_.capacity() * sizeof(std::int64_t) + values_.capacity() * sizeof(float);
}

History::History(int columns, double step_s, std::size_t settling)
    : columns_(static_cast<std::size_t>(columns)),
      settling_(settling),
      step_ns_(
          std::max<std::int64_t>(1, std::llround(std::min(step_s, kLongestStep) * kNsPerSecond))),
      raw_(columns, kRawRows),
      scratch_(kParts * columns_) {
  std::int64_t span = step_ns_;
  for (int l = 0; l < kLevels; ++l) {
    span *= kFactor;
    levels_.push_back({span, RowRing(static_cast<int>(kParts) * columns, kBuckets),
                       std::vector<Sum>(columns_), 0, false});
  }
}

void History::push(std::int64_t time_ns, std::span<const float> row) {
  if (!empty() && time_ns <= last_ns()) forget_from(time_ns);
  raw_.push(time_ns, row);
  if (raw_.size() <= settling_) return;
  const std::size_t settled = raw_.size() - 1 - settling_;
  settle(raw_.time(settled), raw_.row(settled));
}

void History::begin(Level& level, std::int64_t index) const {
  level.begun = true;
  level.open_index = index;
  std::fill(level.open.begin(), level.open.end(), Sum{kUnknown, kUnknown, 0.0, 0});
}

void History::close(Level& level, std::vector<float>& scratch) {
  for (std::size_t c = 0; c < level.open.size(); ++c) {
    const Sum& sum = level.open[c];
    scratch[kParts * c] = sum.low;
    scratch[kParts * c + 1] =
        sum.count > 0 ? static_cast<float>(sum.sum / static_cast<double>(sum.count)) : kUnknown;
    scratch[kParts * c + 2] = sum.high;
  }
  level.buckets.push(level.open_index * level.span_ns, scratch);
  level.begun = false;
}

void History::settle(std::int64_t time_ns, std::span<const float> row) {
  for (Level& level : levels_) {
    const std::int64_t index = floor_division(time_ns, level.span_ns);
    // What time went back to has its buckets already, of before that.
    if (level.buckets.size() > 0 &&
        index * level.span_ns <= level.buckets.time(level.buckets.size() - 1))
      continue;
    if (level.begun && index != level.open_index) close(level, scratch_);
    if (!level.begun) begin(level, index);
    for (std::size_t c = 0; c < columns_; ++c) {
      const float value = row[c];
      if (std::isnan(value)) continue;
      Sum& sum = level.open[c];
      sum.low = sum.count == 0 ? value : std::min(sum.low, value);
      sum.high = sum.count == 0 ? value : std::max(sum.high, value);
      sum.sum += static_cast<double>(value);
      ++sum.count;
    }
  }
}

void History::forget_from(std::int64_t time_ns) {
  while (raw_.size() > 0 && raw_.time(raw_.size() - 1) >= time_ns) raw_.pop();
  for (Level& level : levels_) {
    while (level.buckets.size() > 0 &&
           level.buckets.time(level.buckets.size() - 1) + level.span_ns > time_ns)
      level.buckets.pop();
    level.begun = false;
  }
}

void History::amend(std::size_t rows_ago, int column, float value) {
  if (rows_ago >= std::min(settling_, raw_.size())) return;
  raw_.row(raw_.size() - 1 - rows_ago)[static_cast<std::size_t>(column)] = value;
}

float History::value(std::size_t rows_ago, int column) const {
  if (rows_ago >= raw_.size()) return kUnknown;
  return raw_.row(raw_.size() - 1 - rows_ago)[static_cast<std::size_t>(column)];
}

std::int64_t History::first_ns() const {
  std::int64_t first = raw_.time(0);
  if (!raw_.full()) return first;
  for (const Level& level : levels_)
    if (level.buckets.size() > 0) first = std::min(first, level.buckets.time(0));
  return first;
}

Drawing History::draw(std::int64_t from_ns, std::int64_t until_ns, int points,
                      std::span<const int> columns) const {
  Drawing drawing;
  drawing.reaches.resize(columns.size());
  if (empty() || until_ns < from_ns) return drawing;
  from_ns = std::max(from_ns, first_ns());
  until_ns = std::min(until_ns, last_ns());
  if (until_ns < from_ns) return drawing;

  // -1: the samples themselves.
  int finest = -1;
  const auto reaches_back = [&](const RowRing& ring) {
    return ring.size() > 0 && (!ring.full() || ring.time(0) <= from_ns);
  };
  if (!reaches_back(raw_)) {
    finest = 0;
    while (finest + 1 < kLevels && !reaches_back(levels_[static_cast<std::size_t>(finest)].buckets))
      ++finest;
  }
  drawing.step_s = static_cast<double>(
                       finest < 0 ? step_ns_ : levels_[static_cast<std::size_t>(finest)].span_ns) /
                   kNsPerSecond;

  // The end of a level is told by the one below it, down to the last sample.
  Bins bins(from_ns, until_ns, static_cast<std::size_t>(std::max(points, 1)), columns.size());
  std::int64_t told_until = std::numeric_limits<std::int64_t>::min();
  for (int l = finest; l >= -1; --l) {
    const RowRing& ring = l < 0 ? raw_ : levels_[static_cast<std::size_t>(l)].buckets;
    const std::int64_t span = l < 0 ? step_ns_ : levels_[static_cast<std::size_t>(l)].span_ns;
    std::size_t low = 0, high = ring.size();  // first entry that ends after `from`
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (ring.time(middle) + (l < 0 ? 0 : span - 1) < from_ns)
        low = middle + 1;
      else
        high = middle;
    }
    for (std::size_t i = low; i < ring.size(); ++i) {
      const std::int64_t begins = ring.time(i);
      if (begins > until_ns) break;
      if (begins < told_until) continue;
      const std::int64_t middle = std::clamp(l < 0 ? begins : begins + span / 2, from_ns, until_ns);
      bins.begin(middle, span, static_cast<double>(span), drawing);
      const std::span<const float> row = ring.row(i);
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const auto column = static_cast<std::size_t>(columns[c]);
        bins.add(c, l < 0 ? Reach{row[column], row[column], row[column]}
                          : Reach{row[kParts * column], row[kParts * column + 1],
                                  row[kParts * column + 2]});
      }
      if (l >= 0) told_until = begins + span;
    }
    if (l >= 0 && ring.size() > 0)
      told_until = std::max(told_until, ring.time(ring.size() - 1) + span);
  }
  bins.close(drawing);
  drawing.step_s = std::max(drawing.step_s, static_cast<double>(until_ns - from_ns) / kNsPerSecond /
                                                static_cast<double>(std::max(points, 1)));
  return drawing;
}

std::size_t History::bytes() const {
  std::size_t bytes = raw_.bytes();
  for (const Level& level : levels_)
    bytes += level.buckets.bytes() + level.open.capacity() * sizeof(Sum);
  return bytes;
}

std::size_t History::most_bytes(int columns) {
  const auto width = static_cast<std::size_t>(columns);
  const auto rows = [](std::size_t count, std::size_t floats) {
    return count * (sizeof(std::int64_t) + floats * sizeof(float));
  };
  // A vector may have room for twice of what it holds.
  return 2 * (rows(kRawRows, width) + kLevels * rows(kBuckets, kParts * width)) +
         kLevels * width * sizeof(Sum);
}

}  // namespace mpm::http
