#include "core/mismatch/volterra_terms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"

namespace mpm {
namespace {

using calibration::curvature::kMostInputs;
constexpr int kLags = 2;

int products_of(int inputs) { return inputs * (inputs + 1) / 2; }
int terms_of(int inputs) { return products_of(inputs) + inputs; }

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

VolterraTerms::VolterraTerms(const LinearModel& model, int cv, const RegressionHistory& history,
                             int span) {
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

VolterraTerms::VolterraTerms(const LinearModel& model, int cv, std::vector<int> inputs, int depth)
    : inputs_(std::move(inputs)), centres_(inputs_.size()) {
  for (const int input : inputs_) channels_.push_back(model.channel(cv, input));
  windows_.assign(inputs_.size(), LagWindow(depth + kLags));
}

bool VolterraTerms::possible(const std::vector<int>& inputs, const LinearModel& model) {
  return inputs.size() <= kMostInputs && std::all_of(inputs.begin(), inputs.end(), [&](int input) {
           return input >= 0 && input < model.input_count();
         });
}

void VolterraTerms::archive(Archive& a) {
  // not archived: inputs_ (construction)
  a(centres_, channels_, windows_);
}

int VolterraTerms::most_columns() { return kLags * terms_of(kMostInputs); }

int VolterraTerms::terms() const { return terms_of(static_cast<int>(inputs_.size())); }

int VolterraTerms::columns() const { return kLags * terms(); }

std::array<int, 2> VolterraTerms::product_columns(int a, int b) const {
  const int count = static_cast<int>(inputs_.size());
  const int at = products_of(count) - products_of(count - a) + b - a;
  return {at, terms() + at};
}

std::array<int, 2> VolterraTerms::cube_columns(int a) const {
  const int at = products_of(static_cast<int>(inputs_.size())) + a;
  return {at, terms() + at};
}

bool VolterraTerms::has(int column, int a) const {
  const auto is = [&](const std::array<int, 2>& own) {
    return own[0] == column || own[1] == column;
  };
  if (is(cube_columns(a))) return true;
  for (int b = 0; b < static_cast<int>(inputs_.size()); ++b)
    if (is(product_columns(std::min(a, b), std::max(a, b)))) return true;
  return false;
}

void VolterraTerms::take(std::size_t channel, double input) {
  Eigen::Matrix<double, 1, 1> deviation;
  deviation(0) = input - centres_[channel];
  windows_[channel].push(channels_[channel].output()(0));
  channels_[channel].advance(deviation);
}

void VolterraTerms::push(const RegressionHistory& history) {
  for (std::size_t c = 0; c < inputs_.size(); ++c) take(c, history.input(inputs_[c], 0));
}

void VolterraTerms::fill(int age, double* row) const {
  for (int lag = 0; lag < kLags; ++lag) {
    const auto now = [&](std::size_t a) { return windows_[a].window()[age + lag]; };
    for (std::size_t a = 0; a < windows_.size(); ++a)
      for (std::size_t b = a; b < windows_.size(); ++b) *row++ = now(a) * now(b);
    for (std::size_t a = 0; a < windows_.size(); ++a) *row++ = now(a) * now(a) * now(a);
  }
}

}  // namespace mpm
