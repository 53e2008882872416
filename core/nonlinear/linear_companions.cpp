#include "core/nonlinear/linear_companions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/nonlinear/calibration.hpp"

namespace mpm {

LinearCompanions::LinearCompanions(const RegressionShape& shape, int remembered)
    : inputs_(shape.inputs) {
  const double slowest = *std::max_element(shape.tail_poles.begin(), shape.tail_poles.end());
  const double fastest = calibration::linear_companions::kFasterThanLags * shape.fir_lags;
  // What is slower than any tail that is fitted is no more than a constant.
  double time = std::min(-2.0 / std::log(slowest),
                         static_cast<double>(calibration::usual_errors::kTailFitMost));
  do {
    const double pole = std::exp(-1.0 / time);
    const auto known = [pole](double tail) {
      return std::abs(std::log(tail) / std::log(pole) - 1.0) <
             calibration::linear_companions::kSame;
    };
    if (std::none_of(shape.tail_poles.begin(), shape.tail_poles.end(), known))
      poles_.push_back(pole);
    time *= 0.5;
  } while (time > fastest);
  const std::size_t count = static_cast<std::size_t>(inputs_) * poles_.size();
  origins_.resize(static_cast<std::size_t>(inputs_));
  means_.resize(count);
  windows_.assign(count, LagWindow(remembered));
}

void LinearCompanions::begin(const RegressionHistory& history) {
  for (int i = 0; i < inputs_; ++i)
    origins_[static_cast<std::size_t>(i)] = history.input(i, history.depth() - 1);
  std::fill(means_.begin(), means_.end(), 0.0);
}

// As of the samples before: u(k-1), u(k-2), ...
void LinearCompanions::advance(const RegressionHistory& history, int age) {
  std::size_t at = 0;
  for (int i = 0; i < inputs_; ++i) {
    const double input = history.input(i, age) - origins_[static_cast<std::size_t>(i)];
    for (const double pole : poles_) {
      windows_[at].push(means_[at]);
      means_[at] = pole * means_[at] + (1.0 - pole) * input;
      ++at;
    }
  }
}

void LinearCompanions::archive(Archive& a) {
  // not archived: inputs_, poles_ (construction)
  a(origins_, means_, windows_);
}

void LinearCompanions::fill(int age, double* row) const {
  for (const LagWindow& window : windows_) *row++ = window.window()[age];
}

}  // namespace mpm
