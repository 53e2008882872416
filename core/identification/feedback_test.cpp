#include "core/identification/feedback_test.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <set>

#include "core/identification/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// p-values of each input not depending on some columns beside others.
class InputRegression {
 public:
  explicit InputRegression(const IdentificationData& data) : data_(data), means_(means_of(data)) {
    for (const Run& run : data.runs)
      for (Index k = run.first + kFeedbackLags; k < run.first + run.count; ++k)
        if (data.known.middleRows(k - kFeedbackLags, kFeedbackLags + 1).minCoeff() > 0.0)
          rows_.push_back(k);
  }

  /// Asked: all CVs from `first_lag` to kFeedbackLags rows before, and with `own` their own past,
  /// which else stands beside.
  [[nodiscard]] std::vector<double> p_values(int first_lag, bool own) const {
    const Index inputs = data_.inputs.cols(), cvs = data_.cvs.cols(), lags = kFeedbackLags;
    const Index past = lags * inputs + means_.cols(),
                columns = 1 + past + (lags + 1 - first_lag) * cvs;
    const Index asked = columns - 1 - (own ? 0 : past), beside = columns - asked;
    const auto count = static_cast<Index>(rows_.size());
    std::vector<double> p_values(static_cast<std::size_t>(inputs), 1.0);
    if (count < static_cast<Index>(kRowsPerColumn) * columns) return p_values;
    MatrixXd system(count, columns + inputs);
    for (Index r = 0; r < count; ++r) {
      const Index k = rows_[static_cast<std::size_t>(r)];
      system(r, 0) = 1.0;
      for (Index l = 1; l <= lags; ++l)
        system.row(r).segment(1 + (l - 1) * inputs, inputs) = data_.inputs.row(k - l);
      system.row(r).segment(1 + lags * inputs, means_.cols()) = means_.row(k);
      for (Index l = first_lag; l <= lags; ++l)
        system.row(r).segment(1 + past + (l - first_lag) * cvs, cvs) = data_.cvs.row(k - l);
      system.row(r).tail(inputs) = data_.inputs.row(k);
    }
    const VectorXd sizes = system.colwise().norm().cwiseMax(kNotZero);
    system *= sizes.cwiseInverse().asDiagonal();
    const Eigen::HouseholderQR<MatrixXd> qr(system);
    const auto freedom = static_cast<double>(count - columns);
    for (Index i = 0; i < inputs; ++i) {
      const VectorXd rotated = qr.matrixQR().col(columns + i).head(columns + i + 1);
      const double explained = rotated.segment(beside, asked).squaredNorm();
      const double rest = rotated.tail(i + 1).squaredNorm();
      constexpr double kRounding = kDependent * kDependent;
      if (explained < kRounding) continue;
      p_values[static_cast<std::size_t>(i)] =
          rest < kRounding ? 0.0  // a controller without noise
                           : f_upper_tail(explained / static_cast<double>(asked) / (rest / freedom),
                                          static_cast<double>(asked), freedom);
    }
    return p_values;
  }

 private:
  // Per input and pole the mean of its values before the row, of its run.
  static MatrixXd means_of(const IdentificationData& data) {
    const Index inputs = data.inputs.cols();
    MatrixXd means(data.samples(), inputs * static_cast<Index>(kFeedbackPoles.size()));
    for (const Run& run : data.runs)
      for (std::size_t p = 0; p < kFeedbackPoles.size(); ++p) {
        Eigen::RowVectorXd mean = data.inputs.row(run.first);
        for (Index k = run.first; k < run.first + run.count; ++k) {
          means.row(k).segment(static_cast<Index>(p) * inputs, inputs) = mean;
          mean += (1.0 - kFeedbackPoles[p]) * (data.inputs.row(k) - mean);
        }
      }
    return means;
  }

  const IdentificationData& data_;
  MatrixXd means_;  // samples x (poles x inputs)
  std::vector<Index> rows_;
};

}  // namespace

std::vector<double> feedback_p_values(const IdentificationData& data, int first_lag) {
  return InputRegression(data).p_values(first_lag, false);
}

double feedback_p_value(const IdentificationData& data, int first_lag) {
  double least = 1.0;
  for (const double p_value : feedback_p_values(data, first_lag))
    least = std::min(least, p_value * static_cast<double>(data.inputs.cols()));
  return least;
}

std::vector<bool> test_signals(const IdentificationData& data) {
  const InputRegression regression(data);
  const std::vector<double> by_all = regression.p_values(1, true);
  const std::vector<double> by_cvs = regression.p_values(1, false);
  const auto unforetold = [](double p_value) { return p_value > kFeedback && p_value < 1.0; };
  std::vector<bool> result;
  for (Index i = 0; i < data.inputs.cols(); ++i) {
    const auto s = static_cast<std::size_t>(i);
    std::set<double> values;
    for (Index k = 0; k < data.samples() && values.size() <= kTestLevels; ++k)
      values.insert(data.inputs(k, i));
    const bool few = values.size() <= kTestLevels;
    result.push_back(unforetold(by_all[s]) || (few && unforetold(by_cvs[s])));
  }
  return result;
}

}  // namespace mpm
