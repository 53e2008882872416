#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace mpm::http {

/// What a value was over some time; NaN where it was never known.
struct Reach {
  float low = std::numeric_limits<float>::quiet_NaN();
  float mean = std::numeric_limits<float>::quiet_NaN();
  float high = std::numeric_limits<float>::quiet_NaN();
};

/// What is to be drawn of some columns: `reaches[c][i]` at `times_s[i]`. Where nothing came for
/// long stands a row of NaN.
struct Drawing {
  std::vector<double> times_s;  ///< since 1970, increasing
  double step_s = 0.0;          ///< what one entry stands for
  std::vector<std::vector<Reach>> reaches;
};

/// Rows of a fixed width in the order of their times, the oldest of which make room.
class RowRing {
 public:
  RowRing(int width, std::size_t capacity);

  void push(std::int64_t time_ns, std::span<const float> row);
  void pop();
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::int64_t time(std::size_t index) const { return times_[slot(index)]; }
  [[nodiscard]] std::span<float> row(std::size_t index);
  [[nodiscard]] std::span<const float> row(std::size_t index) const;
  /// Some rows have made room.
  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] std::size_t slot(std::size_t index) const {
    const std::size_t place = first_ + index;
    return place < capacity_ ? place : place - capacity_;
  }

  std::size_t width_, capacity_, first_ = 0, count_ = 0;
  bool full_ = false;
  std::vector<std::int64_t> times_;
  std::vector<float> values_;
};

/// Months of values in a few megabytes: the last samples as they came, and ever coarser levels of
/// buckets, each `kFactor` as long as those of the level below it, that keep the least, the mean
/// and the greatest of each column. Buckets are aligned to 1970. Memory grows with what comes, up
/// to a bound.
class History {
 public:
  static constexpr int kFactor = 8;
  static constexpr int kLevels = 4;  ///< of buckets; 97 days of a unit of one second
  static constexpr std::size_t kRawRows = 4096, kBuckets = 2048;

  /// `step_s`: between rows. The last `settling` rows may still be amended, and are in no bucket
  /// yet.
  History(int columns, double step_s, std::size_t settling = 0);

  /// A row that is not later than the one before takes the place of all from its time on: one axis
  /// cannot show two pasts.
  void push(std::int64_t time_ns, std::span<const float> row);
  /// Of the row so many before the last one, less than `settling`; nothing where it is not there.
  void amend(std::size_t rows_ago, int column, float value);
  /// NaN where the row is not there.
  [[nodiscard]] float value(std::size_t rows_ago, int column) const;

  /// About `points` entries of what lies in [from, until], from the finest level that reaches back
  /// so far: nothing is lost of the least and the greatest.
  [[nodiscard]] Drawing draw(std::int64_t from_ns, std::int64_t until_ns, int points,
                             std::span<const int> columns) const;

  [[nodiscard]] bool empty() const { return raw_.size() == 0; }
  [[nodiscard]] std::int64_t first_ns() const;  ///< of what is kept at all
  [[nodiscard]] std::int64_t last_ns() const { return raw_.time(raw_.size() - 1); }
  [[nodiscard]] std::size_t bytes() const;
  /// It never grows beyond this.
  [[nodiscard]] static std::size_t most_bytes(int columns);

 private:
  struct Sum {
    float low, high;
    double sum;
    int count;
  };
  struct Level {
    std::int64_t span_ns;
    RowRing buckets;  // times: their beginnings
    std::vector<Sum> open;
    std::int64_t open_index = 0;
    bool begun = false;
  };

  void settle(std::int64_t time_ns, std::span<const float> row);
  void begin(Level& level, std::int64_t index) const;
  static void close(Level& level, std::vector<float>& scratch);
  void forget_from(std::int64_t time_ns);

  std::size_t columns_, settling_;
  std::int64_t step_ns_;
  RowRing raw_;
  std::vector<Level> levels_;
  std::vector<float> scratch_;
};

}  // namespace mpm::http
