#include "core/mismatch/joint_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/mismatch/mismatch_detector.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::joint_errors_test {
namespace {

// Two inputs that mostly move as one to one CV; `error`: plant minus model, per input.
struct Loop {
  static constexpr int kSamples = 1500;
  ModelSpec spec = test::channel_model(2, 1,
                                       {{0, 0, TransferFunction{2.0, {20.0}, 0, 4, false}},
                                        {0, 1, TransferFunction{1.0, {8.0}, 0, 2, false}}});
  RegressionShape shape{2, 1, 12, 2, {std::exp(-1.0 / 20.0)}};

  [[nodiscard]] ChannelEvidence evidence(const ModelSpec& error, int input,
                                         std::uint64_t seed) const {
    MismatchDetector detector(shape, {{1.0, 0}}, 200, 30, LinearModel(spec));
    LinearModel wrong(error);
    Eigen::VectorXd u(2), e(1);
    double noise = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const double common = test::uniform(seed, k / 30) > 0.0 ? 1.0 : -1.0;
      for (int i = 0; i < 2; ++i)
        u(i) = common + 0.4 * test::uniform(seed + 1 + static_cast<std::uint64_t>(i), k / 20);
      noise = 0.7 * noise + 0.3 * test::uniform(seed + 9, k);
      e(0) = noise + wrong.output()(0);
      detector.update(u, e);
      wrong.advance(u);
    }
    detector.evaluate(0);
    return detector.evidence(0, input);
  }
};

ModelSpec only(const ModelSpec& spec, std::size_t channel, double gain) {
  ModelSpec one = spec;
  one.channels = {spec.channels[channel]};
  std::get<TransferFunction>(one.channels[0].dynamics).gain *= gain;
  return one;
}

TEST_CASE("a gain error shows beside an input that moves alike, and only where it is") {
  // Expected: what was put in. With the other block free the s.d. of a gain error is some 20 %.
  const Loop loop;
  for (std::uint64_t seed = 100; seed < 1100; seed += 100) {
    CAPTURE(seed);
    for (std::size_t channel = 0; channel < 2; ++channel) {
      const ModelSpec error = only(loop.spec, channel, 0.5);
      const ChannelEvidence found = loop.evidence(error, static_cast<int>(channel), seed);
      CHECK(found.p_value < 1e-4);
      CHECK(std::abs(found.gain_error.value - 0.5) < 4.0 * found.gain_error.deviation);
      CHECK(found.gain_error.deviation < 0.15);
      CHECK(loop.evidence(error, 1 - static_cast<int>(channel), seed).p_value > 1e-4);
    }
  }
}

double left(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
  return (y - columns * columns.colPivHouseholderQr().solve(y)).squaredNorm();
}

TEST_CASE(
    "what an input's usual errors explain is what batch fits with and without them differ by") {
  // Expected: least squares by Eigen on all rows, the inputs' columns multiplied by the usual
  // errors' coefficients; shifts by one sample likewise.
  const Loop loop;
  const RegressionShape& shape = loop.shape;
  const std::vector<ChannelSignatures> signatures =
      channel_signatures(shape, LinearModel(loop.spec));
  RegressionHistory history(shape, 10);
  GivensQr factor(shape.columns(), 1);
  Eigen::MatrixXd rows(900, shape.columns());
  Eigen::VectorXd y(rows.rows());
  Eigen::Index count = 0;
  Eigen::VectorXd u(2), e(1);
  double noise = 0.0;
  while (count < rows.rows()) {
    const auto k = static_cast<std::int64_t>(count);
    for (int i = 0; i < 2; ++i) u(i) = test::uniform(5 + static_cast<std::uint64_t>(i), k / 9);
    noise = 0.7 * noise + test::uniform(7, k);
    e(0) = noise;
    history.push(u, e);
    ++count;
    if (!history.usable(0)) {
      rows.row(count - 1).setZero();
      y(count - 1) = 0.0;
      continue;
    }
    std::vector<double> row(static_cast<std::size_t>(shape.columns()));
    history.fill(0, 0, row.data());
    rows.row(count - 1) = Eigen::Map<Eigen::RowVectorXd>(row.data(), shape.columns());
    y(count - 1) = history.residual(0, 0);
    std::copy(row.begin(), row.end(), factor.row());
    factor.row()[shape.columns()] = y(count - 1);
    factor.update(1.0);
  }
  InputEstimates estimates(shape);
  estimates.read(0, factor);
  const double freedom = 900.0 - shape.columns();
  const double variance = factor.residual_square(0) / freedom;
  JointErrors joint(shape);
  const std::uint64_t before = test::allocation_count();
  joint.read(0, factor, signatures, {variance, variance, freedom}, estimates);
  REQUIRE(joint.adequate());
  (void)joint.channel(1);
  CHECK(test::allocation_count() == before);

  const auto moved = [&](int input, const std::vector<Signature>& errors) {
    Eigen::MatrixXd columns(rows.rows(), static_cast<Eigen::Index>(errors.size()));
    Eigen::VectorXd coefficients(shape.block());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i].filter(estimates.own_past().data(), coefficients);
      columns.col(static_cast<Eigen::Index>(i)) =
          rows.middleCols(shape.lead_in() + input * shape.block(), shape.block()) * coefficients;
    }
    return columns;
  };
  const auto beside = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
    both << a, b;
    return both;
  };
  const Eigen::MatrixXd lead_in = rows.leftCols(shape.lead_in());
  for (int input = 0; input < 2; ++input) {
    CAPTURE(input);
    const Eigen::MatrixXd own = moved(input, signatures[static_cast<std::size_t>(input)].errors);
    const Eigen::MatrixXd others =
        beside(lead_in, moved(1 - input, signatures[static_cast<std::size_t>(1 - input)].errors));
    const JointErrors::Channel& channel = joint.channel(input);
    CHECK(channel.estimate.squaredNorm() ==
          Approx(left(others, y) - left(beside(others, own), y)).epsilon(1e-6));
    // Of a gain error alone: what of it the others' do not explain.
    CHECK(channel.usual.col(0).squaredNorm() == Approx(left(others, own.col(0))).epsilon(1e-6));
    const Eigen::MatrixXd shifts = moved(input, signatures[static_cast<std::size_t>(input)].shifts);
    CHECK(channel.directions.col(error_column::kLater).squaredNorm() ==
          Approx(left(others, shifts.col(0)) - left(beside(others, own), shifts.col(0)))
              .epsilon(1e-6));
    const JointErrors::Freed freed = joint.freed(input, estimates);
    BlockCovariance covariance(estimates);
    covariance.read(freed.factor, freed.first);
    // The block given the others' usual errors: sum of squares that all of it explains.
    double explained = 0.0;
    for (int r = 0; r < shape.block(); ++r)
      explained += std::pow(freed.factor.z(freed.first + r, 0), 2);
    const Eigen::MatrixXd block =
        rows.middleCols(shape.lead_in() + input * shape.block(), shape.block());
    CHECK(explained == Approx(left(others, y) - left(beside(others, block), y)).epsilon(1e-6));
    Eigen::VectorXd coefficients(shape.block());
    signatures[static_cast<std::size_t>(input)].errors[0].filter(estimates.own_past().data(),
                                                                 coefficients);
    coefficients.array() *= estimates.norms(input).array();
    covariance.whiten(coefficients);
    CHECK(coefficients.squaredNorm() == Approx(left(others, own.col(0))).epsilon(1e-6));
  }
}

TEST_CASE("errors that are none of the usual ones are not taken for them") {
  const Loop loop;
  ModelSpec error = only(loop.spec, 0, 1.0);
  error.channels[0].dynamics = TransferFunction{3.0, {}, 0, 11, false};  // at once, 11 samples late
  const ChannelEvidence found = loop.evidence(error, 0, 100);
  const ChannelEvidence other = loop.evidence(error, 1, 100);
  CHECK(found.p_value < 1e-9);
  CHECK_FALSE(found.usual);
  CHECK(other.p_value > 1e-4);
}

}  // namespace
}  // namespace mpm::joint_errors_test
