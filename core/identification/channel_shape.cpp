#include "core/identification/channel_shape.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/identification/calibration.hpp"
#include "core/identification/damped_pair.hpp"
#include "core/model/zero_order_hold.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

bool integrates(ChannelForm form) {
  return form == ChannelForm::kIntegrator || form == ChannelForm::kIntegratorLag;
}

namespace {

bool has_second(ChannelForm form) {
  return form == ChannelForm::kSecondOrder || form == ChannelForm::kSecondOrderLead ||
         form == ChannelForm::kThirdOrderLead;
}

bool has_lead(ChannelForm form) {
  return form == ChannelForm::kSecondOrderLead || form == ChannelForm::kThirdOrderLead;
}

}  // namespace

std::vector<double> lags(const ChannelShape& shape) {
  std::vector<double> times;
  if (shape.form != ChannelForm::kIntegrator && shape.form != ChannelForm::kDamped)
    times.push_back(shape.time_constant);
  if (has_second(shape.form)) times.push_back(shape.second);
  if (shape.form == ChannelForm::kThirdOrderLead) times.push_back(shape.third);
  return times;
}

std::vector<ShapeNumber> free_numbers(const ChannelShape& shape) {
  std::vector<ShapeNumber> numbers = {ShapeNumber::kGain};
  if (!shape.dead_time_known) numbers.push_back(ShapeNumber::kDeadTime);
  if (shape.form != ChannelForm::kIntegrator) numbers.push_back(ShapeNumber::kLogTime);
  if (has_second(shape.form)) numbers.push_back(ShapeNumber::kLogSecond);
  if (shape.form == ChannelForm::kThirdOrderLead) numbers.push_back(ShapeNumber::kLogThird);
  if (shape.form == ChannelForm::kDamped) numbers.push_back(ShapeNumber::kDamping);
  if (has_lead(shape.form)) numbers.push_back(ShapeNumber::kLead);
  return numbers;
}

double number_of(const ChannelShape& shape, ShapeNumber which) {
  switch (which) {
    case ShapeNumber::kGain:
      return shape.gain;
    case ShapeNumber::kDeadTime:
      return shape.dead_time;
    case ShapeNumber::kLogTime:
      return std::log(shape.time_constant);
    case ShapeNumber::kLogSecond:
      return std::log(shape.second);
    case ShapeNumber::kLogThird:
      return std::log(shape.third);
    case ShapeNumber::kLead:
      return shape.lead;
    case ShapeNumber::kDamping:
      return shape.damping;
  }
  return 0.0;
}

void set_number(ChannelShape& shape, ShapeNumber which, double value, double longest) {
  const auto time = [&] { return std::clamp(std::exp(value), kFastest, longest); };
  switch (which) {
    case ShapeNumber::kGain:
      shape.gain = shape.sign != 0 && value * shape.sign < 0.0 ? 0.0 : value;
      break;
    case ShapeNumber::kDeadTime:
      shape.dead_time = std::clamp(value, 0.0, longest);
      break;
    case ShapeNumber::kLogTime:
      shape.time_constant = time();
      break;
    case ShapeNumber::kLogSecond:
      shape.second = time();
      break;
    case ShapeNumber::kLogThird:
      shape.third = time();
      break;
    case ShapeNumber::kLead:
      // Who gives a gain's sign means that of the answer: no inverse response.
      shape.lead = std::clamp(value, shape.sign != 0 ? 0.0 : -longest, longest);
      break;
    case ShapeNumber::kDamping:
      shape.damping = std::clamp(value, kLeastDamping, kMostDamping);
      break;
  }
}

double slowest_time(const ChannelShape& shape) {
  if (shape.form == ChannelForm::kDamped) return shape.time_constant / shape.damping;
  const std::vector<double> times = lags(shape);
  return times.empty() ? 0.0 : *std::max_element(times.begin(), times.end());
}

TransferFunction transfer_function(const ChannelShape& shape, double sample_time_s) {
  TransferFunction tf;
  tf.integrating = integrates(shape.form);
  tf.gain = tf.integrating ? shape.gain / sample_time_s : shape.gain;
  tf.dead_time_s = shape.dead_time * sample_time_s;
  for (const double time : lags(shape)) tf.time_constants_s.push_back(time * sample_time_s);
  if (has_lead(shape.form)) tf.lead_s = shape.lead * sample_time_s;
  return tf;
}

namespace {

VectorXd damped_response(const ChannelShape& shape, const Eigen::Ref<const VectorXd>& input,
                         const std::vector<Run>& runs) {
  const DiscreteFilter filter =
      sampled({shape.time_constant, shape.damping}, shape.gain, shape.dead_time, 1.0);
  VectorXd output(input.size());
  for (const Run& run : runs) {
    const Index first = run.first, count = run.count;
    const double before = input(first), rest = shape.gain * before;
    const auto moved = [&](Index k) { return k > 0 ? output(first + k) - rest : 0.0; };
    for (Index k = 0; k < count; ++k) {
      double sum = -filter.denominator[1] * moved(k - 1) - filter.denominator[2] * moved(k - 2);
      for (std::size_t n = 0; n < filter.numerator.size(); ++n) {
        const Index then = k - 1 - filter.delay_samples - static_cast<Index>(n);
        if (then > 0) sum += filter.numerator[n] * (input(first + then) - before);
      }
      output(first + k) = rest + sum;
    }
  }
  return output;
}

}  // namespace

VectorXd response(const ChannelShape& shape, const Eigen::Ref<const VectorXd>& input,
                  const std::vector<Run>& runs) {
  if (shape.form == ChannelForm::kDamped) return damped_response(shape, input, runs);
  const SampledLag lag = sample_transfer_function(transfer_function(shape, 1.0), 1.0);
  const Index order = lag.transition.rows();
  VectorXd output(input.size());
  VectorXd state(order), next(order);
  for (const auto& [first, count] : runs) {
    const double before = input(first);
    state.setZero(order);
    if (!integrates(shape.form) && order > 0)
      state = (Eigen::MatrixXd::Identity(order, order) - lag.transition)
                  .lu()
                  .solve((lag.from_newer + lag.from_older) * before);
    double through = before;
    for (Index k = 0; k < count; ++k) {
      output(first + k) = lag.output.dot(state) + lag.feed_through * through;
      const double newer = k >= lag.delay ? input(first + k - lag.delay) : before;
      const double older = k > lag.delay ? input(first + k - lag.delay - 1) : before;
      for (Index r = 0; r < order; ++r) {
        double sum = lag.from_newer(r) * newer + lag.from_older(r) * older;
        for (Index c = 0; c <= r; ++c) sum += lag.transition(r, c) * state(c);
        next(r) = sum;
      }
      state.swap(next);
      through = newer;
    }
  }
  return output;
}

}  // namespace mpm
