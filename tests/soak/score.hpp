#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/soak/plant.hpp"

namespace mpm::soak {

/// What became of the alarms.
struct AlarmScore {
  int wrong_times = 0;
  int missed = 0;                  ///< wrong times in which none stood on that channel
  int raised = 0;                  ///< alarms
  std::vector<std::string> wrong;  ///< alarms without a cause, one line each
  double longest_delay_s = 0.0;    ///< from a change to its alarm, on the plant's clock
};

/// By the journal of alarms. A wrong time that is not over, or not `least_s` long, is not asked
/// for; for `grace_s` after its end its alarm may come yet: the memory still holds it.
[[nodiscard]] AlarmScore score(const std::string& alarm_journal,
                               const std::vector<WrongTime>& wrong_times, double least_s,
                               double grace_s);

/// A quantity of several processes, each with a level of its own, at the age that each had: what
/// all of them gain per unit of age, by least squares, and its standard error.
class Slope {
 public:
  /// So many points of one process in a row count as one, their mean: neighbours are alike, and as
  /// many as they are they would make the error far too small.
  explicit Slope(int points_in_mean = 1) : points_in_mean_(points_in_mean) {}

  void add(int process, double age, double value);
  struct Estimate {
    double slope = 0.0, error = 0.0;
    std::size_t points = 0;
  };
  [[nodiscard]] Estimate estimate() const;

 private:
  struct Point {
    int process;
    double age, value;  // sums, of so many
    int count = 1;
  };
  const int points_in_mean_;
  std::vector<Point> points_;
};

}  // namespace mpm::soak
