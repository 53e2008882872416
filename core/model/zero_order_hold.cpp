#include "core/model/zero_order_hold.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/model/calibration.hpp"

namespace mpm {
namespace {

using calibration::model_rounding::kWholeSample;

/// The lags in series behind the held input as one matrix: z = (u, x1, .., xn),
/// z_i' = inflow_i z_{i-1} - outflow_i z_i. Row 0 is the input, which does not move.
struct Cascade {
  Eigen::VectorXd inflow;   ///< 1/s, entry 0 unused
  Eigen::VectorXd outflow;  ///< 1/s, 0 for the input and for an integrator
};

Cascade make_cascade(const TransferFunction& channel) {
  const auto lags = static_cast<Eigen::Index>(channel.time_constants_s.size());
  const Eigen::Index size = 1 + lags + (channel.integrating ? 1 : 0);
  Cascade cascade{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  for (Eigen::Index i = 0; i < lags; ++i) {
    const double rate = 1.0 / channel.time_constants_s[static_cast<std::size_t>(i)];
    cascade.inflow(i + 1) = rate;
    cascade.outflow(i + 1) = rate;
  }
  if (channel.integrating) cascade.inflow(size - 1) = 1.0;
  return cascade;
}

/// (e^a - e^b) / (a - b) without cancellation or overflow for a, b <= 0.
double exponential_slope(double a, double b) {
  const double larger = std::max(a, b);
  const double width = std::abs(a - b);
  return width == 0.0 ? std::exp(larger) : std::exp(larger) * (-std::expm1(-width) / width);
}

/// Diagonal and first subdiagonal of the exponential in closed form.
void set_known_entries(const Cascade& cascade, double time_s, Eigen::MatrixXd& result) {
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    result(i, i) = std::exp(-cascade.outflow(i) * time_s);
    if (i > 0)
      result(i, i - 1) =
          cascade.inflow(i) * time_s *
          exponential_slope(-cascade.outflow(i) * time_s, -cascade.outflow(i - 1) * time_s);
  }
}

/// exp(M t) of the cascade by scaling and squaring. M + c 1 with c = max outflow has no negative
/// entry, so neither series nor squaring cancels; the two diagonals known in closed form are put
/// back after every squaring (Al-Mohy and Higham 2009, section 2).
Eigen::MatrixXd exponential(const Cascade& cascade, double time_s) {
  const Eigen::Index size = cascade.inflow.size();
  const double shift = cascade.outflow.maxCoeff();
  const double norm = (cascade.inflow.maxCoeff() + shift) * time_s;
  const int squarings = norm > 0.5 ? static_cast<int>(std::ceil(std::log2(norm / 0.5))) : 0;
  double scaled_time_s = std::ldexp(time_s, -squarings);

  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    scaled(i, i) = (shift - cascade.outflow(i)) * scaled_time_s;
    if (i > 0) scaled(i, i - 1) = cascade.inflow(i) * scaled_time_s;
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd term = result;
  constexpr int kTerms = 16;  // 0.5^16 / 16! < 1e-18
  for (int power = 1; power <= kTerms; ++power) {
    term = (scaled * term / power).eval();
    result += term;
  }
  result *= std::exp(-shift * scaled_time_s);
  set_known_entries(cascade, scaled_time_s, result);
  for (int i = 0; i < squarings; ++i) {
    result = (result * result).eval();
    scaled_time_s *= 2.0;
    set_known_entries(cascade, scaled_time_s, result);
  }
  return result;
}

void check(const TransferFunction& channel, double sample_time_s) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!positive(sample_time_s)) throw std::invalid_argument("sample time must be positive");
  if (!std::isfinite(channel.gain)) throw std::invalid_argument("gain must be finite");
  if (!std::all_of(channel.time_constants_s.begin(), channel.time_constants_s.end(), positive))
    throw std::invalid_argument("time constants must be positive");
  if (!(channel.dead_time_s >= 0.0 &&
        channel.dead_time_s / sample_time_s < calibration::kLongestDeadTime))
    throw std::invalid_argument("dead time must be in 0 .. 1e6 samples");
  if (!std::isfinite(channel.lead_s)) throw std::invalid_argument("lead must be finite");
  if (channel.lead_s != 0.0 && channel.time_constants_s.empty() && !channel.integrating)
    throw std::invalid_argument("a lead needs at least one time constant");
}

}  // namespace

SampledDelay sampled_delay(double dead_time_s, double sample_time_s) {
  const double delay = dead_time_s / sample_time_s;
  double whole = std::floor(delay);
  double fraction = delay - whole;
  if (fraction > 1.0 - kWholeSample) {
    whole += 1.0;
    fraction = 0.0;
  } else if (fraction < kWholeSample) {
    fraction = 0.0;
  }
  return {static_cast<int>(whole), fraction};
}

SampledLag sample_transfer_function(const TransferFunction& channel, double sample_time_s) {
  check(channel, sample_time_s);

  const SampledDelay delay = sampled_delay(channel.dead_time_s, sample_time_s);
  const double fraction = delay.fraction;
  const Cascade cascade = make_cascade(channel);
  const Eigen::Index order = cascade.inflow.size() - 1;
  SampledLag sampled;
  sampled.delay = delay.whole;
  sampled.transition = Eigen::MatrixXd::Zero(order, order);
  sampled.from_newer = Eigen::VectorXd::Zero(order);
  sampled.from_older = Eigen::VectorXd::Zero(order);
  sampled.output = Eigen::VectorXd::Zero(order);
  if (order == 0) {
    sampled.feed_through = channel.gain;
    return sampled;
  }

  sampled.transition = exponential(cascade, sample_time_s).bottomRightCorner(order, order);
  const Eigen::MatrixXd newer = exponential(cascade, (1.0 - fraction) * sample_time_s);
  sampled.from_newer = newer.col(0).tail(order);
  if (fraction > 0.0) {
    const Eigen::MatrixXd older = exponential(cascade, fraction * sample_time_s);
    sampled.from_older = newer.bottomRightCorner(order, order) * older.col(0).tail(order);
  }

  // y = gain (x_n + lead x_n'), x_n' = inflow z_{n-1} - outflow x_n.
  const double slope_gain = channel.gain * channel.lead_s;
  sampled.output(order - 1) = channel.gain - slope_gain * cascade.outflow(order);
  if (order == 1)
    sampled.feed_through = slope_gain * cascade.inflow(order);
  else
    sampled.output(order - 2) = slope_gain * cascade.inflow(order);
  return sampled;
}

}  // namespace mpm
