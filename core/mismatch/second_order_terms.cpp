#include "core/mismatch/second_order_terms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mismatch/calibration.hpp"

namespace mpm {
namespace {

using calibration::curvature::kMostInputs;
constexpr int kLags = 2;

int products_of(int inputs) { return inputs * (inputs + 1) / 2; }

// Where the input's channel is looked at from.
double centre_of(int input, double operating_point, const RegressionHistory& history, int span) {
  double low = history.input(input, 0), high = low;
  for (int age = 1; age < span; ++age) {
    low = std::min(low, history.input(input, age));
    high = std::max(high, history.input(input, age));
  }
  return low < operating_point && operating_point < high ? operating_point : 0.5 * (low + high);
}

double movement_of(const LagWindow& window, int span) {
  double sum = 0.0, square = 0.0;
  for (int age = 0; age < span; ++age) {
    sum += window.window()[age];
    square += window.window()[age] * window.window()[age];
  }
  return square - sum * sum / span;
}

}  // namespace

SecondOrderTerms::SecondOrderTerms(const LinearModel& model, int cv,
                                   const RegressionHistory& history, int span) {
  struct Candidate {
    int input;
    double centre;
    LinearModel channel;
    LagWindow window;
    double movement;
  };
  std::vector<Candidate> candidates;
  const auto integrating = model.integrating();
  for (int i = 0; i < model.input_count(); ++i) {
    if (integrating(cv, i)) continue;
    const double centre = centre_of(i, model.operating_input()(i), history, span);
    Candidate made{i, centre, model.channel(cv, i), LagWindow(history.depth() + kLags), 0.0};
    Eigen::VectorXd deviation(1);
    deviation(0) = history.input(i, history.depth() - 1) - centre;
    made.channel.reset_steady(deviation);
    for (int age = history.depth() - 1; age >= 0; --age) {
      made.window.push(made.channel.output()(0));
      deviation(0) = history.input(i, age) - centre;
      made.channel.advance(deviation);
    }
    made.movement = movement_of(made.window, span);
    if (made.movement > 0.0) candidates.push_back(std::move(made));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.movement > b.movement; });
  for (std::size_t c = 0; c < std::min<std::size_t>(kMostInputs, candidates.size()); ++c) {
    inputs_.push_back(candidates[c].input);
    centres_.push_back(candidates[c].centre);
    channels_.push_back(std::move(candidates[c].channel));
    windows_.push_back(std::move(candidates[c].window));
  }
}

int SecondOrderTerms::most_columns() { return kLags * products_of(kMostInputs); }

int SecondOrderTerms::columns() const {
  return kLags * products_of(static_cast<int>(inputs_.size()));
}

bool SecondOrderTerms::has(int column, int a) const {
  for (int b = 0; b < static_cast<int>(inputs_.size()); ++b)
    for (const int own : columns_of(std::min(a, b), std::max(a, b)))
      if (own == column) return true;
  return false;
}

std::vector<int> SecondOrderTerms::columns_of(int a, int b) const {
  const int count = static_cast<int>(inputs_.size());
  const int product = products_of(count) - products_of(count - a) + b - a;
  return {product, products_of(count) + product};
}

void SecondOrderTerms::take(std::size_t channel, double input) {
  Eigen::Matrix<double, 1, 1> deviation;
  deviation(0) = input - centres_[channel];
  windows_[channel].push(channels_[channel].output()(0));
  channels_[channel].advance(deviation);
}

void SecondOrderTerms::push(const RegressionHistory& history) {
  for (std::size_t c = 0; c < inputs_.size(); ++c) take(c, history.input(inputs_[c], 0));
}

void SecondOrderTerms::fill(int age, double* row) const {
  for (int lag = 0; lag < kLags; ++lag)
    for (std::size_t a = 0; a < windows_.size(); ++a)
      for (std::size_t b = a; b < windows_.size(); ++b)
        *row++ = windows_[a].window()[age + lag] * windows_[b].window()[age + lag];
}

}  // namespace mpm
