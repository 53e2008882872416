#include "core/statistics/readback.hpp"

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "core/statistics/calibration.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using readback::kLags;
using readback::kMostOf;
using readback::kRowsPerColumn;

constexpr Index kOwn = 1 + kLags;         // the constant and the signal's past
constexpr Index kColumns = kOwn + kLags;  // and one input's

double left_of(const Eigen::Ref<const MatrixXd>& columns, const VectorXd& response) {
  return (response - columns * columns.colPivHouseholderQr().solve(response)).squaredNorm();
}

}  // namespace

std::optional<double> share_left(const Eigen::Ref<const VectorXd>& input,
                                 const Eigen::Ref<const VectorXd>& signal) {
  std::vector<Index> rows;
  for (Index k = kLags; k < signal.size(); ++k)
    if (signal.segment(k - kLags, kLags + 1).allFinite() &&
        input.segment(k - kLags, kLags).allFinite())
      rows.push_back(k);
  const auto count = static_cast<Index>(rows.size());
  if (count + kLags < rows_to_read_back()) return std::nullopt;
  MatrixXd columns(count, kColumns);
  VectorXd response(count);
  columns.col(0).setOnes();
  for (Index r = 0; r < count; ++r) {
    const Index k = rows[static_cast<std::size_t>(r)];
    for (Index lag = 1; lag <= kLags; ++lag) {
      columns(r, lag) = signal(k - lag);
      columns(r, kLags + lag) = input(k - lag);
    }
    response(r) = signal(k);
  }
  const double alone = left_of(columns.leftCols(kOwn), response);
  if (!(alone > 0.0)) return std::nullopt;
  return left_of(columns, response) / alone;
}

int rows_to_read_back() { return kLags + kRowsPerColumn * static_cast<int>(kColumns); }

bool reads_back(const Eigen::Ref<const MatrixXd>& inputs,
                const Eigen::Ref<const VectorXd>& signal) {
  for (Index i = 0; i < inputs.cols(); ++i)
    if (share_left(inputs.col(i), signal).value_or(1.0) < 1.0 - kMostOf) return true;
  return false;
}

}  // namespace mpm
