#include "core/identification/high_order.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/identification/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

int longest_lag(const IdentificationData& data) {
  const double mean_run =
      static_cast<double>(data.samples()) / static_cast<double>(data.runs.size());
  const int longest = std::clamp(static_cast<int>(kLagShare * mean_run), kShortestLag, kLongestLag);
  return std::min(longest, static_cast<int>(mean_run / 2.0));
}

std::vector<Index> rows_with_past(const std::vector<Run>& runs, const VectorXd& known, int past,
                                  Index skipped) {
  std::vector<Index> rows;
  for (const auto& [first, count] : runs) {
    Index before = 0;
    for (Index k = first; k < first + count; ++k) {
      if (known(k) == 0.0) {
        before = 0;
        continue;
      }
      if (before >= past && k - first >= skipped) rows.push_back(k);
      ++before;
    }
  }
  return rows;
}

std::vector<LagBlock> lag_blocks(int longest) {
  std::vector<LagBlock> blocks;
  int first = 1;
  double width = 1.0;
  while (first <= longest) {
    if (first > kDenseLags) width *= kBlockGrowth;
    const int last = std::min(longest, first + static_cast<int>(width) - 1);
    blocks.push_back({first, last});
    first = last + 1;
  }
  return blocks;
}

MatrixXd lagged_sums(const Eigen::Ref<const VectorXd>& input, const std::vector<LagBlock>& blocks,
                     const std::vector<Run>& runs) {
  MatrixXd sums(input.size(), static_cast<Index>(blocks.size()));
  for (const auto& [first, count] : runs) {
    VectorXd before(count + 1);  // sum of the run's values before a row
    before(0) = 0.0;
    for (Index k = 0; k < count; ++k) before(k + 1) = before(k) + input(first + k);
    const double held = input(first);
    const auto up_to = [&](Index k) { return k >= 0 ? before(k) : held * static_cast<double>(k); };
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (Index k = 0; k < count; ++k)
        sums(first + k, static_cast<Index>(b)) =
            up_to(k - blocks[b].first + 1) - up_to(k - blocks[b].last);
  }
  return sums;
}

HighOrderModel high_order_model(const IdentificationData& data, int cv, int past) {
  HighOrderModel model;
  model.past = past;
  int longest = longest_lag(data);
  const auto inputs = data.inputs.cols();
  std::vector<Index> rows;
  Index levels = 0, columns = 0;
  for (;;) {  // fewer lags until the rows suffice
    model.blocks = lag_blocks(longest);
    rows = rows_with_past(data.runs, data.known.col(cv), model.past,
                          std::max(model.past, longest / 4));
    levels = static_cast<Index>(data.runs.size());
    columns = model.past + inputs * static_cast<Index>(model.blocks.size());
    if (static_cast<double>(rows.size()) >= kRowsPerColumn * static_cast<double>(columns + levels))
      break;
    if (longest <= 2) return model;
    longest /= 2;
    model.past = std::min(model.past, std::max(2, model.past / 2));
  }
  const auto count = static_cast<Index>(rows.size());
  MatrixXd system = MatrixXd::Zero(count, levels + columns + 1);
  for (Index r = 0, run = 0; r < count; ++r) {
    const Index k = rows[static_cast<std::size_t>(r)];
    while (run + 1 < levels && data.runs[static_cast<std::size_t>(run) + 1].first <= k) ++run;
    system(r, run) = 1.0;
    for (int m = 1; m <= model.past; ++m) system(r, levels + m - 1) = data.cvs(k - m, cv);
    system(r, levels + columns) = data.cvs(k, cv);
  }
  for (Index i = 0; i < inputs; ++i) {
    const MatrixXd sums = lagged_sums(data.inputs.col(i), model.blocks, data.runs);
    for (Index r = 0; r < count; ++r)
      system.row(r).segment(levels + model.column_of(static_cast<int>(i)), sums.cols()) =
          sums.row(rows[static_cast<std::size_t>(r)]);
  }
  const Eigen::HouseholderQR<MatrixXd> qr(system);
  const MatrixXd triangle = qr.matrixQR().topRows(system.cols()).triangularView<Eigen::Upper>();
  model.factor = triangle.block(levels, levels, columns, columns);
  model.right = triangle.col(levels + columns).segment(levels, columns);
  const double left = triangle(levels + columns, levels + columns);
  model.rows = static_cast<double>(count);
  model.variance = left * left / static_cast<double>(count - columns - levels);
  const VectorXd sizes = model.factor.colwise().norm().cwiseMax(kNotZero);
  const MatrixXd scaled = model.factor * sizes.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<MatrixXd> solver(scaled);
  solver.setThreshold(kDependent);
  model.noise = solver.solve(model.right).cwiseQuotient(sizes).head(model.past);
  model.sound = std::isfinite(model.variance) && model.variance > 0.0;
  return model;
}

}  // namespace mpm
