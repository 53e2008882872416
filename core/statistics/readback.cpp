#include "core/statistics/readback.hpp"

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "core/statistics/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using readback::kLags;
using readback::kMostOf;
using readback::kRowsPerColumn;

int rows_to_read_back(int inputs) { return kLags + kRowsPerColumn * (1 + kLags + kLags * inputs); }

bool reads_back(const Eigen::Ref<const MatrixXd>& inputs,
                const Eigen::Ref<const VectorXd>& signal) {
  const Index own = 1 + kLags, all = own + kLags * inputs.cols();
  std::vector<Index> rows;
  for (Index k = kLags; k < signal.size(); ++k)
    if (signal.segment(k - kLags, kLags + 1).allFinite() &&
        inputs.middleRows(k - kLags, kLags).allFinite())
      rows.push_back(k);
  const auto count = static_cast<Index>(rows.size());
  if (count + kLags < rows_to_read_back(static_cast<int>(inputs.cols()))) return false;
  MatrixXd columns(count, all);
  VectorXd response(count);
  for (Index r = 0; r < count; ++r) {
    const Index k = rows[static_cast<std::size_t>(r)];
    columns(r, 0) = 1.0;
    for (Index lag = 1; lag <= kLags; ++lag) {
      columns(r, lag) = signal(k - lag);
      for (Index i = 0; i < inputs.cols(); ++i)
        columns(r, own + i * kLags + lag - 1) = inputs(k - lag, i);
    }
    response(r) = signal(k);
  }
  const auto left = [&](Index width) {
    const MatrixXd used = columns.leftCols(width);
    return (response - used * used.colPivHouseholderQr().solve(response)).squaredNorm();
  };
  const double alone = left(own);
  return alone > 0.0 && left(all) < (1.0 - kMostOf) * alone;
}

}  // namespace mpm
