#pragma once

#include <vector>

#include "core/mismatch/regression_history.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// More linear columns than the linear test has: of each input exponentially weighted means of
/// twice its slowest tail, half of it, a quarter, and so on, down to what its pulse lags show. An
/// error of a time constant leaves decays that the tail alone follows roughly, which is enough to
/// find it; what is left over would pass for nonlinear where the error is large.
///
/// Allocates in the constructor only.
class LinearCompanions {
 public:
  /// `remembered` rows can be filled.
  LinearCompanions(const RegressionShape& shape, int remembered);

  [[nodiscard]] int columns() const { return static_cast<int>(windows_.size()); }
  /// At rest at the oldest sample of the history; then as `NonlinearTerms`.
  void begin(const RegressionHistory& history);
  void advance(const RegressionHistory& history, int age);
  void fill(int age, double* row) const;

  void archive(Archive& a);

 private:
  int inputs_;
  std::vector<double> poles_;       // of each input's means
  std::vector<double> origins_;     // per input
  std::vector<double> means_;       // input-major, about the origin
  std::vector<LagWindow> windows_;  // of these
};

}  // namespace mpm
