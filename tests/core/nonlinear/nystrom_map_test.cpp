#include "core/nonlinear/nystrom_map.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <stdexcept>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

Eigen::MatrixXd some_points(int dimension, int count) {
  Eigen::MatrixXd points(dimension, count);
  for (int p = 0; p < count; ++p)
    for (int d = 0; d < dimension; ++d)
      points(d, p) = 2.0 * test::uniform(static_cast<std::uint64_t>(d), p);
  return points;
}

Eigen::MatrixXd features_of(const FeatureMap& map, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd features(points.cols(), map.outputs());
  Eigen::VectorXd one(map.outputs());
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    const Eigen::VectorXd point = points.col(p);
    map.apply(point.data(), one.data());
    features.row(p) = one.transpose();
  }
  return features;
}

// What a constant and the points themselves leave of the exact kernel.
Eigen::MatrixXd exact(const NystromMap& map, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd linear(points.cols(), points.rows() + 1);
  linear << Eigen::VectorXd::Ones(points.cols()), points.transpose();
  const Eigen::MatrixXd q = Eigen::MatrixXd::Identity(points.cols(), points.cols()) -
                            linear * linear.colPivHouseholderQr().solve(
                                         Eigen::MatrixXd::Identity(points.cols(), points.cols()));
  return q * kernel_matrix(map.kernel(), points) * q;
}

double distance(const NystromMap& map, const Eigen::MatrixXd& points) {
  const Eigen::MatrixXd features = features_of(map, points);
  const Eigen::MatrixXd wanted = exact(map, points);
  return (features * features.transpose() - wanted).norm() / wanted.norm();
}

}  // namespace

TEST_CASE("with every point a landmark and every component taken the kernel is exact") {
  const int dimension = GENERATE(1, 2);
  const Eigen::MatrixXd points = some_points(dimension, 24);
  NystromMap map(dimension, KernelKind::kGaussian, 24, 24 - dimension - 1);
  map.begin(points);
  CHECK(distance(map, points) < 1e-6);  // eigenvalues below 1e-10 of the largest are left out
  CHECK(map.held() == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("more components come nearer, and say how near") {
  const Eigen::MatrixXd points = some_points(2, 48);
  double before = 1.0;
  for (const int components : {1, 3, 6, 12}) {
    NystromMap map(2, KernelKind::kGaussian, 48, components);
    map.begin(points);
    const double now = distance(map, points);
    CHECK(now < before);
    before = now;
  }
  NystromMap map(2, KernelKind::kGaussian, 48, 6);
  map.begin(points);
  CHECK(map.held() > 0.7);  // of the trace; what the calibration says of it
  CHECK(map.held() < 1.0);
}

TEST_CASE("what is linear is left out at the landmarks") {
  const Eigen::MatrixXd points = some_points(1, 30);
  NystromMap map(1, KernelKind::kLinearPlusGaussian, 30, 5);
  map.begin(points);
  const Eigen::MatrixXd features = features_of(map, points);
  CHECK((points * features).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(features.colwise().sum().cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a Nystrom map says nothing before it begins, and allocates nothing after it") {
  NystromMap map(2, KernelKind::kGaussian, 20, 4);
  Eigen::VectorXd features = Eigen::VectorXd::Ones(4);
  const Eigen::Vector2d point(0.3, -0.2);
  map.apply(point.data(), features.data());
  CHECK(features.isZero());
  map.begin(some_points(2, 60));
  const std::uint64_t before = test::allocation_count();
  map.apply(point.data(), features.data());
  CHECK(test::allocation_count() == before);
  CHECK_FALSE(features.isZero());
  map.begin(Eigen::MatrixXd::Zero(2, 60));  // an input that stands still
  map.apply(point.data(), features.data());
  CHECK(features.isZero());
  CHECK_THROWS_AS(NystromMap(2, KernelKind::kGaussian, 5, 3), std::invalid_argument);
}

}  // namespace mpm
