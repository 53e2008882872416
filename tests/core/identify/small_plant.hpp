#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/identify/fit/problem.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"
#include "tests/core/counter_noise.hpp"

/// Small plants in closed form, without any simulator of ours.
namespace mpm::test {

/// White, mean 0, variance 1 (uniform).
inline Eigen::VectorXd white(std::uint64_t stream, Eigen::Index rows) {
  return Eigen::VectorXd::NullaryExpr(
      rows, [&](Eigen::Index k) { return std::sqrt(3.0) * uniform(stream, k); });
}

/// White and normal, variance 1 (Box and Muller 1958).
inline Eigen::VectorXd normal(std::uint64_t stream, Eigen::Index rows) {
  return Eigen::VectorXd::NullaryExpr(rows, [&](Eigen::Index k) {
    const double radius = 0.5 * (1.0 - uniform(stream, 2 * k));  // in (0, 1]
    return std::sqrt(-2.0 * std::log(radius)) * std::cos(M_PI * uniform(stream, 2 * k + 1));
  });
}

/// +1 or -1, drawn anew every `hold` rows; begins with `hold` rows of 0.
inline Eigen::VectorXd telegraph(std::uint64_t stream, Eigen::Index rows, Eigen::Index hold) {
  return Eigen::VectorXd::NullaryExpr(rows, [&](Eigen::Index k) {
    if (k < hold) return 0.0;
    return uniform(stream, k / hold) < 0.0 ? -1.0 : 1.0;
  });
}

/// x(k) = a x(k-1) + e(k), x(0) = e(0).
inline Eigen::VectorXd autoregressive(const Eigen::Ref<const Eigen::VectorXd>& white, double a) {
  Eigen::VectorXd x = white;
  for (Eigen::Index k = 1; k < x.size(); ++k) x(k) += a * x(k - 1);
  return x;
}

/// gain / (T s + 1) e^{-dead s} behind a hold, sampled every unit of time, `dead` in whole samples:
/// y(k+1) = p y(k) + gain (1 - p) u(k - dead), p = e^{-1/T}; from rest.
inline Eigen::VectorXd first_order(const Eigen::Ref<const Eigen::VectorXd>& u, double gain,
                                   double time_constant, Eigen::Index dead = 0) {
  const double pole = std::exp(-1.0 / time_constant);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index k = 0; k + 1 < u.size(); ++k)
    y(k + 1) = pole * y(k) + gain * (1.0 - pole) * (k >= dead ? u(k - dead) : 0.0);
  return y;
}

/// Of one lag each, sampled once a second, all origins 0.
inline ChannelSpec lag(int cv, int input, double gain, double time_constant_s,
                       double dead_time_s = 0.0) {
  return {cv, input, TransferFunction{gain, {time_constant_s}, 0.0, dead_time_s, false}, {}};
}

inline ModelSpec model_of(std::vector<ChannelSpec> channels, int inputs, int cvs) {
  ModelSpec model;
  model.input_count = inputs;
  model.cv_count = cvs;
  model.channels = std::move(channels);
  model.input_blocks.resize(static_cast<std::size_t>(inputs));
  model.output_blocks.resize(static_cast<std::size_t>(cvs));
  model.input_origin = Eigen::VectorXd::Zero(inputs);
  model.output_origin = Eigen::VectorXd::Zero(cvs);
  return model;
}

inline Recording recording_of(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& cvs) {
  return {0.0, 1.0, inputs, cvs, Eigen::MatrixXd(cvs.rows(), 0)};
}

/// What a fit would hold of a CV whose residual is `residual` and whose noise has `coefficients`,
/// all rows but those without a past alike.
struct KnownCv {
  CvData data;
  CvFit fit;
};

inline KnownCv known_cv(const Eigen::VectorXd& residual, const Eigen::VectorXd& coefficients) {
  KnownCv cv;
  const Eigen::Index rows = residual.size();
  cv.data.measured = residual;
  cv.data.known = cv.data.weights = Eigen::VectorXd::Ones(rows);
  cv.data.weights.head(coefficients.size()).setZero();
  cv.data.nuisances.resize(rows, 0);
  cv.data.rows = static_cast<double>(rows - coefficients.size());
  cv.fit.noise.coefficients = coefficients;
  cv.fit.residual = residual;
  cv.fit.innovations = cv.fit.noise.apply(residual);
  cv.fit.variance = cv.fit.innovations.squaredNorm() / cv.data.rows;
  return cv;
}

}  // namespace mpm::test
