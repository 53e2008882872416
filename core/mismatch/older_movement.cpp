#include "core/mismatch/older_movement.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"

namespace mpm {

namespace limits = calibration::older_movement;

OlderMovement::OlderMovement(const RegressionShape& shape, double lambda, int remembered)
    : inputs_(shape.inputs),
      block_(shape.block()),
      lambda_(lambda),
      depth_(remembered),
      all_(static_cast<Eigen::Index>(shape.inputs) * shape.block()),
      remembered_(all_),
      row_(all_.mean) {
  if (lambda < 1.0)
    depth_ = std::min(depth_, static_cast<int>(std::ceil(limits::kMemories / (1.0 - lambda))));
}

// West 1979, with rows that fade.
void OlderMovement::Squares::take(const Eigen::VectorXd& row, double lambda) {
  rows = lambda * rows + 1.0;
  for (Eigen::Index c = 0; c < row.size(); ++c) {
    const double off = row(c) - mean(c);
    mean(c) += off / rows;
    square(c) = lambda * square(c) + off * (row(c) - mean(c));
  }
}

void OlderMovement::Squares::clear() {
  rows = 0.0;
  mean.setZero();
  square.setZero();
}

bool OlderMovement::outweighs(const RegressionHistory& history) {
  if (lambda_ == 1.0) return false;
  history.fill_inputs(0, row_.data());
  all_.take(row_, lambda_);
  ++samples_;
  if (samples_ <= depth_ || samples_ % std::max(depth_ / limits::kLooks, 1) != 0) return false;
  remembered_.clear();
  for (int age = depth_ - 1; age >= 0; --age) {
    history.fill_inputs(age, row_.data());
    remembered_.take(row_, lambda_);
  }
  // Of what moves alike all the time the rest is forgotten.
  const double usual = 1.0 - std::pow(lambda_, depth_);
  for (int i = 0; i < inputs_; ++i) {
    if (rests(i, history)) continue;
    for (Eigen::Index c = static_cast<Eigen::Index>(i) * block_; c < (i + 1) * block_; ++c) {
      if (!(remembered_.square(c) < limits::kOutweighed * usual * all_.square(c))) continue;
      all_ = remembered_;
      return true;
    }
  }
  return false;
}

bool OlderMovement::rests(int input, const RegressionHistory& history) const {
  const double now = history.input(input, 0);
  for (int age = 1; age < depth_ / limits::kLately; ++age)
    if (std::abs(history.input(input, age) - now) > calibration::kRounding * std::abs(now))
      return false;
  return true;
}

void OlderMovement::Squares::archive(Archive& a) { a(rows, mean, square); }

void OlderMovement::archive(Archive& a) {
  // not archived: inputs_, block_, lambda_, depth_ (construction)
  // not archived: remembered_, row_ (each look anew)
  a(all_, samples_);
}

}  // namespace mpm
