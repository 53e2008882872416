#include "core/identify/fit/convolution.hpp"

#include <algorithm>
#include <unsupported/Eigen/FFT>

namespace mpm {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

VectorXd convolved(const Eigen::Ref<const VectorXd>& response, const Eigen::Ref<const VectorXd>& x,
                   double x_before) {
  const Index rows = x.size();
  VectorXd result = VectorXd::Constant(rows, x_before * response.sum());
  const Index taps = std::min(response.size(), rows - 1);
  if (taps < 1) return result;
  Index length = 1;
  while (length < rows + taps) length *= 2;
  VectorXd moves = VectorXd::Zero(length), weights = moves, sum(length);
  moves.head(rows) = x.array() - x_before;
  weights.segment(1, taps) = response.head(taps);
  // Its tables of sines take longer than a transform, so each thread keeps them.
  thread_local Eigen::FFT<double> transform(Eigen::FFT<double>::impl_type(),
                                            Eigen::FFT<double>::HalfSpectrum);
  VectorXcd of_moves(length / 2 + 1), of_weights(length / 2 + 1);
  transform.fwd(of_moves, moves);
  transform.fwd(of_weights, weights);
  of_moves = of_moves.cwiseProduct(of_weights).eval();
  transform.inv(sum, of_moves, length);
  return result + sum.head(rows);
}

}  // namespace mpm
