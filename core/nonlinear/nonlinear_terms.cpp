#include "core/nonlinear/nonlinear_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/nonlinear/calibration.hpp"
#include "core/nonlinear/nystrom_map.hpp"
#include "core/nonlinear/polynomial_map.hpp"
#include "core/nonlinear/random_map.hpp"

namespace mpm {
namespace {

namespace nonlinear_terms = calibration::nonlinear_terms;
using Exponents = PolynomialMap::Exponents;

// A square, and features of a kernel behind it.
class SquareAnd : public FeatureMap {
 public:
  explicit SquareAnd(std::unique_ptr<FeatureMap> others)
      : FeatureMap(1, 1 + others->outputs()), others_(std::move(others)) {}
  void begin(const Eigen::Ref<const Eigen::MatrixXd>& points) override { others_->begin(points); }
  void apply(const double* point, double* features) const override {
    *features = *point * *point;
    others_->apply(point, features + 1);
  }
  void archive(Archive& a) override { a(*others_); }

 private:
  std::unique_ptr<FeatureMap> others_;
};

std::unique_ptr<FeatureMap> kernel_map(NonlinearTest test, int dimension) {
  const bool pair = dimension > 1;
  if (test == NonlinearTest::kKernel)
    return std::make_unique<NystromMap>(
        dimension, KernelKind::kGaussian, nonlinear_terms::kLandmarks,
        pair ? nonlinear_terms::kPairComponents : nonlinear_terms::kComponents);
  return std::make_unique<RandomMap>(
      dimension, pair ? nonlinear_terms::kPairFrequencies : nonlinear_terms::kFrequencies,
      nonlinear_terms::kFrequencySeed);
}

// Of one value; its square comes first.
std::unique_ptr<FeatureMap> curve(NonlinearTest test, std::vector<Exponents> monomials) {
  if (test == NonlinearTest::kPolynomial)
    return std::make_unique<PolynomialMap>(1, std::move(monomials));
  return std::make_unique<SquareAnd>(kernel_map(test, 1));
}

std::unique_ptr<FeatureMap> product(NonlinearTest test) {
  if (test == NonlinearTest::kPolynomial)
    return std::make_unique<PolynomialMap>(2, std::vector<Exponents>{{1, 1}});
  return kernel_map(test, 2);
}

struct TermMoments {
  double sum = 0.0, square = 0.0;
  int count = 0;

  void take(double value) {
    sum += value;
    square += value * value;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0.0; }
  // 0 where it is rounding.
  [[nodiscard]] double deviation() const {
    if (count < 2) return 0.0;
    const double variance = (square - sum * sum / count) / count;
    return variance > calibration::nonlinear_rounding::kEigenvalue * square / count
               ? std::sqrt(variance)
               : 0.0;
  }
};

}  // namespace

NonlinearTerms::NonlinearTerms(const LinearModel& model, int cv, double pole, NonlinearTest test,
                               int remembered)
    : cv_(cv) {
  if (test == NonlinearTest::kOff) throw std::invalid_argument("no nonlinear terms");
  const auto integrating = model.integrating();
  const Eigen::MatrixXd gain = model.steady_gain();
  for (int i = 0; i < model.input_count(); ++i) {
    const ChannelPath path(model, cv, i, pole);
    Channel channel{path,
                    {},
                    curve(test, {{2, 0}, {3, 0}}),
                    curve(test, {{2, 0}}),
                    InputElement(InputBlock(Deadband{nonlinear_terms::kPlayWidth}), 0.0),
                    gain(cv, i) != 0.0 && !integrating(cv, i)};
    channel.curved.assign(static_cast<std::size_t>(channel.input_map->outputs()) + 2, path);
    for (int f = 0; f < channel.input_map->outputs(); ++f)
      terms_.push_back({i, i, NonlinearKind::kInputCurve});
    terms_.push_back({i, i, NonlinearKind::kHysteresis});
    for (int f = 0; f < 1 + channel.channel_map->outputs(); ++f)
      terms_.push_back({i, i, NonlinearKind::kChannelCurve});
    channels_.push_back(std::move(channel));
  }
  const int crossed = std::min(nonlinear_terms::kMostCrossed, inputs());
  for (int a = 0; a < crossed; ++a)
    for (int b = a + 1; b < crossed; ++b) {
      Pair pair{a, b, product(test)};
      for (int f = 0; f < pair.map->outputs(); ++f)
        terms_.push_back({a, b, NonlinearKind::kInteraction});
      pairs_.push_back(std::move(pair));
    }
  sum_map_ = test == NonlinearTest::kPolynomial ? curve(test, {{3, 0}}) : kernel_map(test, 1);
  for (int f = 0; f < sum_map_->outputs(); ++f)
    terms_.push_back({0, -1, NonlinearKind::kOutputCurve});
  for (int t = 0; t < terms(); ++t) {
    const Term& term = terms_[static_cast<std::size_t>(t)];
    const bool goes_on = t > 0 && term.goes_with(terms_[static_cast<std::size_t>(t) - 1]);
    if (!goes_on) groups_.emplace_back();
    for (int lag = 0; lag < nonlinear_terms::kLags; ++lag)
      groups_.back().push_back(lag * terms() + t);
  }
  values_.resize(terms_.size());
  windows_.assign(terms_.size(), LagWindow(remembered + nonlinear_terms::kLags));
  // NOLINTNEXTLINE(clang-analyzer-cplusplus.NewDeleteLeaks): the channels have what was made
}

int NonlinearTerms::columns_of(NonlinearTest test, int inputs) {
  int input = 0, channel = 0, pair = 0, sum = 0;  // terms of one sample
  switch (test) {
    case NonlinearTest::kOff:
      return 0;
    case NonlinearTest::kPolynomial:
      input = 2, channel = pair = sum = 1;
      break;
    case NonlinearTest::kKernel:
      input = channel = 1 + nonlinear_terms::kComponents, pair = nonlinear_terms::kPairComponents;
      sum = nonlinear_terms::kComponents;
      break;
    case NonlinearTest::kRandomFeatures:
      input = channel = 1 + 2 * nonlinear_terms::kFrequencies,
      pair = 2 * nonlinear_terms::kPairFrequencies;
      sum = 2 * nonlinear_terms::kFrequencies;
      break;
  }
  const int crossed = std::min(nonlinear_terms::kMostCrossed, inputs);
  return nonlinear_terms::kLags *
         (inputs * (input + 2 + channel) + crossed * (crossed - 1) / 2 * pair + sum);
}

int NonlinearTerms::columns() const { return nonlinear_terms::kLags * terms(); }

const NonlinearTerms::Term& NonlinearTerms::term_of(int group) const {
  return terms_[static_cast<std::size_t>(columns_of_group(group).front())];
}

bool NonlinearTerms::has(int group, int input) const {
  const Term& term = term_of(group);
  return term.second < term.first ? channels_[static_cast<std::size_t>(input)].modelled
                                  : term.first == input || term.second == input;
}

NonlinearKind NonlinearTerms::kind(int group) const { return term_of(group).kind; }

int NonlinearTerms::square_of(int input) const {
  const Channel& channel = channels_.front();
  return input * (static_cast<int>(channel.curved.size()) + channel.channel_map->outputs());
}

// Of x + c x^2 the local gain is 1 + 2 c x, x of s.d. 1.
double NonlinearTerms::coefficient_of(int input, double variation) const {
  const Channel& channel = channels_[static_cast<std::size_t>(input)];
  return channel.modelled ? variation / 4 * channel.scale : 0.0;
}

void NonlinearTerms::input_functions(int input, double x, double* functions) const {
  const FeatureMap& map = *channels_[static_cast<std::size_t>(input)].input_map;
  std::vector<double> values(static_cast<std::size_t>(map.outputs()));
  map.apply(&x, values.data());
  for (const double value : values)  // columns go lag by lag within each function
    functions = std::fill_n(functions, nonlinear_terms::kLags, value);
}

double NonlinearTerms::standardised(double value, double centre, double scale) {
  return scale > 0.0 ? std::clamp((value - centre) / scale, -nonlinear_terms::kFarthest,
                                  nonlinear_terms::kFarthest)
                     : 0.0;
}

double NonlinearTerms::input_of(std::size_t channel, const RegressionHistory& history,
                                int age) const {
  const Channel& of = channels_[channel];
  return standardised(history.input(static_cast<int>(channel), age), of.centre, of.scale);
}

double NonlinearTerms::output_of(const Channel& channel) const {
  return standardised(channel.linear.output(), channel.output_centre, channel.output_scale);
}

// The input is standardised, the residual is not.
double NonlinearTerms::state_of(const Channel& channel, double residual) const {
  return channel.modelled ? channel.scale * channel.linear.output() + residual : 0.0;
}

double NonlinearTerms::residual_of(const RegressionHistory& history, int age) const {
  const double residual = history.residual(cv_, age);
  return std::isfinite(residual) ? residual : residual_;
}

double NonlinearTerms::sum_of_outputs() const {
  double sum = 0.0;
  for (const Channel& channel : channels_)
    if (channel.modelled) sum += channel.scale * channel.linear.output();
  return sum;
}

void NonlinearTerms::begin(const RegressionHistory& history, int span) {
  measure_inputs(history, span);
  rest(history);
  measure_outputs(history, span);
  choose_pairs();
  const auto count = static_cast<Eigen::Index>(sum_points_.size());
  const auto inputs = static_cast<Eigen::Index>(channels_.size());
  const Eigen::Map<const Eigen::MatrixXd> in(input_points_.data(), inputs, count);
  const Eigen::Map<const Eigen::MatrixXd> out(output_points_.data(), inputs, count);
  for (Eigen::Index i = 0; i < inputs; ++i) {
    channels_[static_cast<std::size_t>(i)].input_map->begin(in.row(i));
    channels_[static_cast<std::size_t>(i)].channel_map->begin(out.row(i));
  }
  for (Pair& pair : pairs_) {
    Eigen::MatrixXd points(2, count);
    points.row(0) = out.row(pair.a);
    points.row(1) = out.row(pair.b);
    pair.map->begin(points);
  }
  sum_map_->begin(Eigen::Map<const Eigen::MatrixXd>(sum_points_.data(), 1, count));
  rest(history);
}

void NonlinearTerms::measure_inputs(const RegressionHistory& history, int span) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    TermMoments moments;
    for (int age = 0; age < span; ++age) moments.take(history.input(static_cast<int>(i), age));
    channels_[i].centre = moments.mean();
    channels_[i].scale = moments.deviation();
  }
}

// What the channels give over the span, and points of it, evenly in time.
void NonlinearTerms::measure_outputs(const RegressionHistory& history, int span) {
  std::vector<TermMoments> moments(channels_.size()), states(channels_.size());
  TermMoments sums;
  input_points_.clear();
  output_points_.clear();
  sum_points_.clear();
  const int stride = std::max(1, span / nonlinear_terms::kLandmarks);
  for (int age = history.depth() - 1; age >= 0; --age) {
    if (age < span) {
      residual_ = residual_of(history, age);
      for (std::size_t i = 0; i < channels_.size(); ++i) {
        moments[i].take(channels_[i].linear.output());
        states[i].take(state_of(channels_[i], residual_));
      }
      sums.take(sum_of_outputs());
      if (age % stride == 0) {
        for (std::size_t i = 0; i < channels_.size(); ++i) {
          input_points_.push_back(input_of(i, history, age));
          output_points_.push_back(channels_[i].linear.output());
        }
        sum_points_.push_back(sum_of_outputs());
      }
    }
    for (std::size_t i = 0; i < channels_.size(); ++i)
      channels_[i].linear.advance(input_of(i, history, age));
  }
  sum_centre_ = sums.mean();
  sum_scale_ = sums.deviation();
  for (double& point : sum_points_) point = standardised(point, sum_centre_, sum_scale_);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels_[i].output_centre = moments[i].mean();
    channels_[i].output_scale = moments[i].deviation();
    channels_[i].state_centre = states[i].mean();
    channels_[i].state_scale = states[i].deviation();
  }
  for (std::size_t p = 0; p < output_points_.size(); ++p) {
    const Channel& channel = channels_[p % channels_.size()];
    output_points_[p] =
        standardised(output_points_[p], channel.output_centre, channel.output_scale);
  }
}

// Of the inputs that move the CV most; a channel that the model lacks moves it least.
void NonlinearTerms::choose_pairs() {
  const auto movement = [this](int i) {
    const Channel& channel = channels_[static_cast<std::size_t>(i)];
    return channel.modelled ? channel.scale * channel.output_scale : 0.0;
  };
  std::vector<int> order(channels_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return movement(a) > movement(b); });
  order.resize(static_cast<std::size_t>(std::min(nonlinear_terms::kMostCrossed, inputs())));
  std::sort(order.begin(), order.end());
  std::size_t at = 0;
  auto term = static_cast<std::size_t>(square_of(inputs()));
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size(); ++b, ++at) {
      pairs_[at].a = order[a];
      pairs_[at].b = order[b];
      for (int f = 0; f < pairs_[at].map->outputs(); ++f, ++term) {
        terms_[term].first = order[a];
        terms_[term].second = order[b];
      }
    }
}

// What goes through the channel of a sample, into `values_`; `linear` is as of the same sample.
void NonlinearTerms::bend(Channel& channel, double x, double residual) {
  channel.input_map->apply(&x, values_.data());
  double* const behind = values_.data() + channel.input_map->outputs();
  behind[0] = x - channel.play.apply(x, 0.0);
  const double state =
      standardised(state_of(channel, residual), channel.state_centre, channel.state_scale);
  behind[1] = state * state;
}

// As of the oldest sample.
void NonlinearTerms::rest(const RegressionHistory& history) {
  residual_ = 0.0;
  residual_ = residual_of(history, history.depth() - 1);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const double x = input_of(i, history, history.depth() - 1);
    channel.linear.rest(x);
    channel.play.reset(x);
    bend(channel, x, residual_);
    for (std::size_t f = 0; f < channel.curved.size(); ++f) channel.curved[f].rest(values_[f]);
  }
}

void NonlinearTerms::push_terms() {
  double* at = values_.data();
  for (Channel& channel : channels_) {
    for (const ChannelPath& path : channel.curved) *at++ = path.output();
    const double g = output_of(channel);
    channel.channel_map->apply(&g, at);
    at += channel.channel_map->outputs();
  }
  for (const Pair& pair : pairs_) {
    const std::array<double, 2> point = {output_of(channels_[static_cast<std::size_t>(pair.a)]),
                                         output_of(channels_[static_cast<std::size_t>(pair.b)])};
    pair.map->apply(point.data(), at);
    at += pair.map->outputs();
  }
  const double sum = standardised(sum_of_outputs(), sum_centre_, sum_scale_);
  sum_map_->apply(&sum, at);
  for (std::size_t t = 0; t < windows_.size(); ++t) windows_[t].push(values_[t]);
}

void NonlinearTerms::Channel::archive(Archive& a) {
  // not archived: modelled (construction)
  a(linear, curved, *input_map, *channel_map, play, centre, scale, output_centre, output_scale,
    state_centre, state_scale);
}

void NonlinearTerms::Pair::archive(Archive& archive) { archive(a, b, *map); }

void NonlinearTerms::Term::archive(Archive& a) {
  // not archived: kind (construction)
  a(first, second);
}

void NonlinearTerms::archive(Archive& a) {
  // not archived: values_, input_points_, output_points_, sum_points_ (empty between calls)
  // not archived: cv_, groups_ (construction)
  a(channels_, pairs_, *sum_map_, sum_centre_, sum_scale_, terms_, windows_, residual_);
  const auto has = [this](int input) { return input >= 0 && input < inputs(); };
  for (const Pair& pair : pairs_)
    a.require(has(pair.a) && has(pair.b), "a pair of inputs that are not there");
}

void NonlinearTerms::advance(const RegressionHistory& history, int age) {
  push_terms();
  residual_ = residual_of(history, age);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const double x = input_of(i, history, age);
    bend(channel, x, residual_);
    channel.linear.advance(x);
    for (std::size_t f = 0; f < channel.curved.size(); ++f) channel.curved[f].advance(values_[f]);
  }
}

void NonlinearTerms::fill(int age, double* row) const {
  for (int lag = 0; lag < nonlinear_terms::kLags; ++lag)
    for (const LagWindow& window : windows_) *row++ = window.window()[age + lag];
}

}  // namespace mpm
