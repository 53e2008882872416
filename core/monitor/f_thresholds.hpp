#pragma once

#include <vector>

namespace mpm {

/// F at which a test's p-value is a given level. The quantile takes a search, so it is kept until
/// the degrees of freedom have changed a little. No allocation after construction, as long as there
/// are no more kinds of tests than room was made for.
class FThresholds {
 public:
  FThresholds() { kept_.reserve(kMostKinds); }

  /// `numerator`, `denominator`: degrees of freedom, 0 where nothing was tested; `tests`: of which
  /// the smaller p counts, multiplied by their number; `level`: of p.
  [[nodiscard]] double at(double numerator, double denominator, int tests, double level);

  template <class Archive>
  void archive(Archive& a) {
    a.varying(kept_);
  }

 private:
  static constexpr std::size_t kMostKinds = 32;
  struct Kept {
    double numerator = 0.0;
    int tests = 1;
    double denominator = 0.0;
    double value = 0.0;
    template <class Archive>
    void archive(Archive& a) {
      a(numerator, tests, denominator, value);
    }
  };
  std::vector<Kept> kept_;  // one per kind of test
};

}  // namespace mpm
