#include "core/identification/feedback_test.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "core/identification/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double feedback_p_value(const IdentificationData& data, int first_lag) {
  const Index inputs = data.inputs.cols(), cvs = data.cvs.cols(), lags = kFeedbackLags;
  std::vector<Index> rows;
  for (const Run& run : data.runs)
    for (Index k = run.first + lags; k < run.first + run.count; ++k)
      if (data.known.middleRows(k - lags, lags + 1).minCoeff() > 0.0) rows.push_back(k);
  const Index own = 1 + lags * inputs, asked = (lags + 1 - first_lag) * cvs;
  const auto count = static_cast<Index>(rows.size());
  if (count < static_cast<Index>(kRowsPerColumn) * (own + asked)) return 1.0;
  MatrixXd system(count, own + asked + inputs);
  for (Index r = 0; r < count; ++r) {
    const Index k = rows[static_cast<std::size_t>(r)];
    system(r, 0) = 1.0;
    for (Index l = 1; l <= lags; ++l)
      system.row(r).segment(1 + (l - 1) * inputs, inputs) = data.inputs.row(k - l);
    for (Index l = first_lag; l <= lags; ++l)
      system.row(r).segment(own + (l - first_lag) * cvs, cvs) = data.cvs.row(k - l);
    system.row(r).tail(inputs) = data.inputs.row(k);
  }
  const VectorXd sizes = system.colwise().norm().cwiseMax(kNotZero);
  system *= sizes.cwiseInverse().asDiagonal();
  const Eigen::HouseholderQR<MatrixXd> qr(system);
  const Index columns = own + asked;
  const auto freedom = static_cast<double>(count - columns);
  double least = 1.0;
  for (Index i = 0; i < inputs; ++i) {
    const VectorXd rotated = qr.matrixQR().col(columns + i).head(columns + i + 1);
    const double explained = rotated.segment(own, asked).squaredNorm();
    const double rest = rotated.tail(i + 1).squaredNorm();
    constexpr double kRounding = kDependent * kDependent;
    if (explained < kRounding) continue;
    if (rest < kRounding) return 0.0;  // a controller without noise
    least = std::min(least, f_upper_tail(explained / static_cast<double>(asked) / (rest / freedom),
                                         static_cast<double>(asked), freedom));
  }
  return std::min(1.0, least * static_cast<double>(inputs));
}

}  // namespace mpm
