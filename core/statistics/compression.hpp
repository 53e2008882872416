#pragma once

#include <array>

#include "core/statistics/calibration.hpp"

namespace mpm {

class Archive;

/// Recognises in one signal's values what a historian's compression leaves of them: values held
/// until they have left a deadband, or straight lines between the few that were kept (interpolated
/// retrieval). A sensor of coarse resolution repeats values and changes as well, but its changes
/// are often the smallest there is, and after a deadband they never are; one that is stuck rests
/// seldom and long; what is read only now and then (an analyser) changes by any size, and a test
/// signal by few. Told anew after each batch of changes. Straight lines from a noise-free
/// simulation with a bend every few samples would look the same. No allocation.
class Compression {
 public:
  enum class Kind : unsigned char { kNone, kHeld, kInterpolated };

  void take(double value);
  /// Tells of what has come of the batch, if that is enough.
  void conclude();
  /// As the last batch of changes was.
  [[nodiscard]] Kind kind() const { return kind_; }
  /// Of that batch, signal units: kHeld: the deadband, or a little more.
  [[nodiscard]] double smallest_change() const { return smallest_change_; }
  /// Of that batch: share of the values that are the one before, and values per change.
  [[nodiscard]] double held_share() const { return 1.0 - 1.0 / held_for_; }
  [[nodiscard]] double held_for() const { return held_for_; }

  /// Whether two changes in a row are one line.
  [[nodiscard]] static bool straight(double change, double last_change);

  void archive(Archive& a);

 private:
  /// Since the batch began.
  struct Batch {
    int values = 0, changes = 0;
    int rests = 0;          // runs of one value
    double smallest = 0.0;  // change, or difference between the sizes of two in a row
    int straight = 0, bends = 0, returns = 0;  // changes; back by the same size
    void archive(Archive& a);
  };
  void take_change(double change);
  void judge();
  [[nodiscard]] bool held();
  /// Of the changes, in order.
  [[nodiscard]] bool few_sizes() const;
  [[nodiscard]] bool interpolated() const;
  [[nodiscard]] double share_below(double size) const;

  Batch batch_;
  std::array<double, compression::kChanges> sizes_{};  // of the batch's changes
  bool begun_ = false;
  bool rests_ = false;  // the last value is the one before
  double last_ = 0.0, last_change_ = 0.0;
  bool was_straight_ = false;
  Kind kind_ = Kind::kNone;
  double smallest_change_ = 0.0;
  double held_for_ = 1.0;
};

}  // namespace mpm
