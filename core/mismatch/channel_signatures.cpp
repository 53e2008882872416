#include "core/mismatch/channel_signatures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mpm {
namespace {

Eigen::VectorXd lag_with_slowest_tail(const BlockBasis& basis) {
  Eigen::VectorXd pulse = Eigen::VectorXd::Zero(basis.length());
  const double pole = std::exp(-1.0 / basis.slowest());
  for (int l = 1; l < basis.length(); ++l) pulse(l) = (1.0 - pole) * std::pow(pole, l - 1);
  return pulse;
}

double usual_gain(const std::vector<ChannelSignatures>& channels, int cvs, int cv, int input) {
  const auto inputs = static_cast<int>(channels.size()) / cvs;
  const auto gain = [&](int j, int i) {
    return std::abs(channels[static_cast<std::size_t>(i * cvs + j)].gain);
  };
  std::vector<double> products;
  for (int i = 0; i < inputs; ++i)
    for (int j = 0; j < cvs; ++j)
      if (gain(j, input) > 0.0 && gain(cv, i) > 0.0 && gain(j, i) > 0.0)
        products.push_back(gain(j, input) * gain(cv, i) / gain(j, i));
  if (products.empty()) return 0.0;
  const auto middle = products.begin() + static_cast<std::ptrdiff_t>((products.size() - 1) / 2);
  std::nth_element(products.begin(), middle, products.end());
  return *middle;
}

}  // namespace

std::vector<ChannelSignatures> channel_signatures(const RegressionShape& shape,
                                                  const LinearModel& model) {
  const BlockBasis basis(shape.fir_lags, shape.tail_poles);
  const Eigen::MatrixXd gains = model.steady_gain();
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating = model.integrating();
  std::vector<ChannelSignatures> channels;
  for (int i = 0; i < shape.inputs; ++i) {
    for (int j = 0; j < shape.cvs; ++j) {
      ChannelSignatures channel;
      const Eigen::VectorXd pulse = model.impulse_response(j, i, basis.length());
      if (pulse.cwiseAbs().maxCoeff() > 0.0) {
        channel.gain = gains(j, i) * (integrating(j, i) ? basis.slowest() : 1.0);
        for (const Eigen::VectorXd& error : usual_errors(pulse, integrating(j, i)))
          channel.errors.emplace_back(basis, error, shape.residual_order, shape.residual_poles);
        for (const int shift : {1, -1})
          channel.shifts.emplace_back(basis, shifted(pulse, shift) - pulse, shape.residual_order,
                                      shape.residual_poles);
      } else {
        channel.errors.emplace_back(basis, lag_with_slowest_tail(basis), shape.residual_order,
                                    shape.residual_poles);
      }
      channels.push_back(std::move(channel));
    }
  }
  for (int i = 0; i < shape.inputs; ++i) {
    for (int j = 0; j < shape.cvs; ++j) {
      ChannelSignatures& channel = channels[static_cast<std::size_t>(i * shape.cvs + j)];
      if (channel.gain == 0.0) channel.usual_gain = usual_gain(channels, shape.cvs, j, i);
    }
  }
  return channels;
}

}  // namespace mpm
