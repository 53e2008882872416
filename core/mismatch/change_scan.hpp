#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// What a CV's channels did at some moment inside its memory.
enum class ChangeKind : unsigned char { kBegan, kEnded, kOther };

struct ChangePoint {
  ChangeKind kind = ChangeKind::kBegan;
  int samples = 0;         ///< since the change
  int resolution = 0;      ///< samples by which it may be less or more
  double gain = 0.0;       ///< by how much it beats "no change", in residual variances
  int input = -1;          ///< that explains the rows since then best, were it alone
  double p_value = 1.0;    ///< of no change in any input, from these rows; kEnded: 1
  double statistic = 0.0;  ///< the F of that input's block; kEnded: 0
  double numerator = 0.0, denominator = 0.0;  ///< its degrees of freedom

  template <class Archive>
  void archive(Archive& a) {
    a.within(kind, ChangeKind::kBegan, ChangeKind::kOther);
    a(samples, resolution, gain, input, p_value, statistic, numerator, denominator);
  }
};

/// Looks for the moment at which a CV's mismatch began, ended or became another one, in the rows
/// that its memory rests on. "No change" fits all inputs' blocks to all rows; the rivals fit them
///
///     to the rows after a moment (began), to those before it (ended), or twice, before and after,
///
/// the constant and the residuals' own lags in common. The first two have as many parameters as "no
/// change" and must beat it by a margin; the last has all blocks once more and must beat these by
/// what that many could gain by chance (Andrews 1993, on the likelihood ratio over all moments);
/// where it wins but no input explains anything since then, it is an end, if that too beats "no
/// change".
/// One pass over the rows in each direction gives the residual squares for all moments at once. No
/// allocation unless CVs with and without Volterra terms take turns.
class ChangeScan {
 public:
  explicit ChangeScan(const RegressionShape& shape);

  [[nodiscard]] std::optional<ChangePoint> scan(const MismatchDetector& detector, int cv);

 private:
  /// One CV's rows.
  struct Rows {
    const RegressionHistory& history;
    const ResidualRegression& regression;
    int cv;
    /// Decays since the start could stand for a change, so that nothing is said of the time.
    [[nodiscard]] int span() const { return std::min(regression.span(), history.settled()); }
  };
  /// What a part of the rows leaves once the inputs' blocks are eliminated (or, where the inputs
  /// take no part, were never there): the triangle of the lead-in columns and the residual square.
  struct Part {
    std::vector<double> triangle;  // lead_in rows of lead_in + 1
    double square = 0.0;
    int freedom = 0;  // rows - columns
  };
  /// Residual variance; 0 where the rows are too few to tell.
  [[nodiscard]] static double variance_of(const Part& part) {
    return part.freedom >= calibration::change_scan::kFewestFreedom ? part.square / part.freedom
                                                                    : 0.0;
  }

  void take_shape(const ResidualRegression& regression);
  void pass(const Rows& rows, bool newest_first, bool with_inputs, std::vector<Part>& parts);
  void store(const GivensQr& factor, int first, int rows, Part& part) const;
  /// The moment, at least `fewest` samples ago, at which the two parts beat no change by most, and
  /// by more than `least`; 0 samples if none does.
  [[nodiscard]] ChangePoint strongest(ChangeKind kind, const std::vector<Part>& after,
                                      const std::vector<Part>& before, double least, int fewest);
  [[nodiscard]] double gain_of(const Part& after, const Part& before, double least);
  [[nodiscard]] double joined(const Part& a, const Part& b);

  struct InputFit {
    int input = -1;
    double p_value = 1.0;
    double statistic = 0.0, numerator = 0.0, denominator = 0.0;
  };
  void name_input(const Rows& rows, ChangePoint& change);
  [[nodiscard]] InputFit best_input(const Rows& rows, int samples, bool strict);
  double fit_input(const Rows& rows, int input, int samples, bool strict, GivensQr& factor);

  RegressionShape shape_;
  RowFeed feed_;
  std::vector<int> moments_;  // ages
  double constant_ = 0.0;     // residual square of no change
  double per_square_ = 0.0;   // 1 / its residual variance
  GivensQr whole_;            // [inputs | lead-in]
  GivensQr lead_in_;
  GivensQr one_input_;  // [lead-in | one input]
  Eigen::VectorXd inputs_;
  std::vector<Part> after_with_, after_without_, before_with_, before_without_;
};

}  // namespace mpm
