#include "tests/hidden/cv_noise.hpp"

#include <Eigen/QR>
#include <cmath>

#include "sim/signals/random_stream.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;

constexpr int kBefore = 400;  ///< samples after which the start is forgotten, pole .97

}  // namespace

double CvNoise::deviation() const {
  return sigma * std::sqrt((1.0 + 2.0 * pole * moving + moving * moving) / (1.0 - pole * pole));
}

Eigen::MatrixXd draw_noise(const std::vector<CvNoise>& cvs, Index samples, std::uint64_t seed) {
  Eigen::MatrixXd noise(samples, static_cast<Index>(cvs.size()));
  for (std::size_t cv = 0; cv < cvs.size(); ++cv) {
    const CvNoise& how = cvs[cv];
    sim::RandomStream normal(seed, sim::StreamPurpose::kNoise, cv);
    sim::RandomStream tails(seed, sim::StreamPurpose::kTails, cv);
    double value = 0.0;
    double last = 0.0;
    for (Index k = -kBefore; k < samples; ++k) {
      double e = how.sigma;
      e *= how.freedom > 2.0
               ? tails.student_t(how.freedom) * std::sqrt((how.freedom - 2.0) / how.freedom)
               : normal.normal();
      if (k >= how.onset) e *= std::sqrt(how.variance_ratio);
      value = how.pole * value + e + how.moving * last;
      last = e;
      if (k >= 0) noise(k, static_cast<Index>(cv)) = value;
    }
  }
  return noise;
}

Eigen::VectorXd whitened(const CvNoise& noise, const Eigen::VectorXd& signal) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(signal.size());
  double e = 0.0;
  for (Index k = 1; k < signal.size(); ++k) {
    e = signal(k) - noise.pole * signal(k - 1) - noise.moving * e;
    result(k) = e / noise.sigma;
  }
  return result;
}

double evidence(const CvNoise& noise, const Eigen::VectorXd& signal,
                const std::vector<Eigen::VectorXd>& others) {
  Eigen::MatrixXd columns(signal.size(), static_cast<Index>(others.size()) + 1);
  columns.col(0) = whitened(noise, Eigen::VectorXd::Ones(signal.size()));
  for (std::size_t i = 0; i < others.size(); ++i)
    columns.col(static_cast<Index>(i) + 1) = whitened(noise, others[i]);
  const Eigen::VectorXd wanted = whitened(noise, signal);
  return (wanted - columns * columns.colPivHouseholderQr().solve(wanted)).squaredNorm();
}

}  // namespace mpm::hidden
