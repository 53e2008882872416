#pragma once

#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/page/plot_json.hpp"

/// The signals of a diagnosis as series: of one stretch of the recording, or of all of it.
namespace mpm::report {

/// Of the whole record's plots, some 7 bytes each.
inline constexpr std::size_t kAllValues = 60'000;
inline constexpr std::size_t kMostPoints = 1'200;    ///< of one line there
inline constexpr std::size_t kWindowPoints = 500;    ///< of one line in a window
inline constexpr Eigen::Index kShortestWindow = 60;  ///< rows

/// A recording with both simulations of it.
struct Simulated {
  const Recording& recording;
  const Eigen::MatrixXd& before;  ///< no columns where there was no simulation
  const Eigen::MatrixXd& after;
};
[[nodiscard]] Simulated fitted(const DiagnosisRun& run);
/// Only where there is a validation.
[[nodiscard]] Simulated unseen(const DiagnosisRun& run);

/// Unknown throughout where `block` has no such column.
[[nodiscard]] Series rows_of(const Eigen::MatrixXd& block, Eigen::Index column, const Run& rows);
/// Input of the extended model, MVs first.
[[nodiscard]] Series input_rows(const DiagnosisRun& run, const Recording& recording, int input,
                                const Run& rows);
[[nodiscard]] Series difference(const Series& a, const Series& b);

/// One CV's measured values, both simulations and what they leave.
struct CvSeries {
  Series measured, before, after, residual_before, residual_after;
};
[[nodiscard]] CvSeries cv_rows(const Simulated& data, Eigen::Index cv, const Run& rows);

/// Clock of the data at a row, s.
[[nodiscard]] double clock_at(const Recording& recording, Eigen::Index row);

/// Rows as one axis of time, so many of them said as one value.
class Track {
 public:
  /// In the order of the clock where the runs allow it; else one behind the other, as time since
  /// the beginning.
  Track(const Recording& recording, const std::vector<Run>& runs, std::size_t points);

  [[nodiscard]] std::size_t every() const { return every_; }
  [[nodiscard]] const std::vector<Stretch>& stretches() const { return stretches_; }
  /// What the axis says at this row.
  [[nodiscard]] double at(Eigen::Index row) const;
  /// The axis of a plot.
  void under(Plot& plot) const;

  /// `make(values of one run)` of each run in turn, with an unknown value between two.
  template <class Make>
  [[nodiscard]] Series along(const Series& all, const Make& make) const {
    Series result;
    for (const Run& run : runs_) {
      if (&run != &runs_.front()) result.push_back(std::numeric_limits<double>::quiet_NaN());
      const auto first = all.begin() + run.first;
      const Series part = make(Series(first, first + run.count));
      result.insert(result.end(), part.begin(), part.end());
    }
    return result;
  }
  [[nodiscard]] Series means(const Series& all) const;
  /// A line, and where it is thinned what it covers.
  void draw(Plot& plot, const std::string& name, Role role, const Series& all) const;

 private:
  std::vector<Run> runs_;
  std::vector<Stretch> stretches_;
  std::vector<double> starts_;  ///< of each run, on the axis
  double step_s_;
  std::size_t every_;
  bool clock_;
};

/// What stands at an axis: "T1, degC".
[[nodiscard]] std::string axis_text(const std::string& tag, const std::string& unit);

}  // namespace mpm::report
