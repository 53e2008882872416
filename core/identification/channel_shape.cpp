#include "core/identification/channel_shape.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/identification/calibration.hpp"
#include "core/model/zero_order_hold.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

bool integrates(ChannelForm form) {
  return form == ChannelForm::kIntegrator || form == ChannelForm::kIntegratorLag;
}

std::vector<ShapeNumber> free_numbers(const ChannelShape& shape) {
  std::vector<ShapeNumber> numbers = {ShapeNumber::kGain};
  if (!shape.dead_time_known) numbers.push_back(ShapeNumber::kDeadTime);
  if (shape.form != ChannelForm::kIntegrator) numbers.push_back(ShapeNumber::kLogTime);
  if (shape.form == ChannelForm::kSecondOrder || shape.form == ChannelForm::kSecondOrderLead)
    numbers.push_back(ShapeNumber::kLogSecond);
  if (shape.form == ChannelForm::kSecondOrderLead) numbers.push_back(ShapeNumber::kLead);
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
    case ShapeNumber::kLead:
      return shape.lead;
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
    case ShapeNumber::kLead:
      // Who gives a gain's sign means that of the answer: no inverse response.
      shape.lead = std::clamp(value, shape.sign != 0 ? 0.0 : -longest, longest);
      break;
  }
}

TransferFunction transfer_function(const ChannelShape& shape, double sample_time_s) {
  TransferFunction tf;
  tf.integrating = integrates(shape.form);
  tf.gain = tf.integrating ? shape.gain / sample_time_s : shape.gain;
  tf.dead_time_s = shape.dead_time * sample_time_s;
  if (shape.form != ChannelForm::kIntegrator)
    tf.time_constants_s.push_back(shape.time_constant * sample_time_s);
  if (shape.form == ChannelForm::kSecondOrder || shape.form == ChannelForm::kSecondOrderLead)
    tf.time_constants_s.push_back(shape.second * sample_time_s);
  if (shape.form == ChannelForm::kSecondOrderLead) tf.lead_s = shape.lead * sample_time_s;
  return tf;
}

VectorXd response(const ChannelShape& shape, const Eigen::Ref<const VectorXd>& input,
                  const std::vector<Run>& runs) {
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
