#pragma once

#include <array>

#include "core/signal/calibration.hpp"

namespace mpm {

/// Recognises in one signal's values what a historian's compression leaves of them: values held
/// until they have left a deadband, or straight lines between the few that were kept (interpolated
/// retrieval). A sensor of coarse resolution repeats values and changes as well, but its changes
/// are often the smallest there is, and after a deadband they never are; one that is stuck rests
/// seldom and long. Told anew after each batch of changes. Straight lines from a noise-free
/// simulation with a bend every few samples would look the same. No allocation.
class Compression {
 public:
  void take(double value);
  /// As the last batch of changes was.
  [[nodiscard]] bool found() const { return found_; }

 private:
  /// Since the batch began.
  struct Batch {
    int values = 0, changes = 0;
    int rests = 0;          // runs of one value
    double smallest = 0.0;  // jump, or difference between the sizes of two in a row
    int straight = 0, bends = 0, returns = 0;  // changes; back by the same size
  };
  void take_change(double change);
  [[nodiscard]] bool held() const;
  [[nodiscard]] bool interpolated() const;

  Batch batch_;
  std::array<double, calibration::compression::kChanges> jumps_{};  // sizes of the batch's changes
  bool begun_ = false;
  int run_ = 0;  // values in a row equal to the one before
  double last_ = 0.0, last_change_ = 0.0;
  bool was_straight_ = false;
  bool found_ = false;
};

}  // namespace mpm
