#include "core/mismatch/input_errors.hpp"

#include <algorithm>

namespace mpm {

InputErrors::InputErrors(int columns)
    : feed_(columns + 1 + kShifts),
      last_(columns, 1 + kShifts),
      channel_{Eigen::VectorXd::Zero(kUsualErrors),
               Eigen::MatrixXd::Zero(kUsualErrors, kUsualErrors),
               Eigen::MatrixXd::Zero(kUsualErrors, error_column::kCount)} {}

const InputErrors::Channel& InputErrors::read(const GivensQr& all, int own, int shift) {
  last_.clear();
  const int columns = all.columns();
  for (int r = 0; r < columns; ++r) {
    double* row = feed_.next_row(last_);
    std::fill(row, row + columns, 0.0);
    for (int c = r; c < columns; ++c) {
      const bool mine = c >= own && c < own + kUsualErrors;
      const int to = mine ? columns - kUsualErrors + c - own : c < own ? c : c - kUsualErrors;
      row[to] = all.r(r, c);
    }
    row[columns] = all.z(r, 0);
    for (int s = 0; s < kShifts; ++s) row[columns + 1 + s] = all.z(r, shift + s);
  }
  feed_.flush(last_);
  const int first = columns - kUsualErrors;
  for (int r = 0; r < kUsualErrors; ++r) {
    channel_.estimate(r) = last_.z(first + r, 0);
    for (int c = 0; c < kUsualErrors; ++c)
      channel_.usual(r, c) = c < r ? 0.0 : last_.r(first + r, first + c);
    channel_.directions(r, error_column::kLater) = last_.z(first + r, 1);
    channel_.directions(r, error_column::kEarlier) = last_.z(first + r, 2);
  }
  channel_.directions.col(error_column::kGain) = channel_.usual.col(0);
  channel_.directions.col(error_column::kTime) = channel_.usual.col(1);
  return channel_;
}

}  // namespace mpm
