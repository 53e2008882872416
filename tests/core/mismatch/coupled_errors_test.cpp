#include "core/mismatch/coupled_errors.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::coupled_errors_test {
namespace {

// Two inputs and two CVs in series: what CV 0 does reaches CV 1 through a lag, and so does what
// disturbs it.
struct Series {
  static constexpr double kPassed = 0.3, kKept = 0.7;  // e_1(k) = kept e_1(k-1) + passed e_0(k-1)
  static inline const double kLag = -1.0 / std::log(kKept);
  ModelSpec spec = test::channel_model(2, 2,
                                       {{0, 0, TransferFunction{2.0, {10.0}, 0, 1, false}},
                                        {0, 1, TransferFunction{-1.5, {6.0}, 0, 2, false}},
                                        {1, 0, TransferFunction{2.0, {10.0, kLag}, 0, 2, false}},
                                        {1, 1, TransferFunction{-1.5, {6.0, kLag}, 0, 3, false}}});
  RegressionShape shape{2, 2, 24, 3, {std::exp(-1.0 / 10.0)}};

  [[nodiscard]] Eigen::Vector2d inputs(std::uint64_t seed, std::int64_t k) const {
    return {test::uniform(seed + 1, k / 15), test::uniform(seed + 2, k / 11)};
  }
};

struct Noise {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  void advance(std::uint64_t seed, std::int64_t k) {
    value = {
        0.8 * value(0) + 0.2 * test::uniform(seed + 8, k),
        Series::kKept * value(1) + Series::kPassed * value(0) + 0.02 * test::uniform(seed + 9, k)};
  }
};

// `gain_errors`: of each channel as in `Series::spec`, relative.
MismatchDetector watched(const Series& plant, const std::vector<double>& gain_errors,
                         std::uint64_t seed) {
  MismatchDetector detector(plant.shape, {{1.0, 0}}, 200, 30, LinearModel(plant.spec));
  ModelSpec error = plant.spec;
  for (std::size_t c = 0; c < gain_errors.size(); ++c)
    std::get<TransferFunction>(error.channels[c].dynamics).gain *= gain_errors[c];
  LinearModel wrong(error);
  Noise noise;
  for (std::int64_t k = 0; k < 2500; ++k) {
    const Eigen::VectorXd u = plant.inputs(seed, k);
    detector.update(u, noise.value + wrong.output());
    wrong.advance(u);
    noise.advance(seed, k);
  }
  return detector;
}

void evaluate_all(MismatchDetector& detector) {
  for (int turn = 0; turn < 2; ++turn)
    for (int cv = 0; cv < 2; ++cv) detector.evaluate(cv);
}

}  // namespace

TEST_CASE("a wrong channel is not laid to the CV that its own CV disturbs") {
  // Expected: what was put in. By the second CV's regression alone, which takes 0.3 of a residual
  // that the inputs move for noise, its channel is wrong.
  const Series plant;
  for (std::uint64_t seed = 100; seed < 1100; seed += 100) {
    CAPTURE(seed);
    MismatchDetector detector = watched(plant, {0.3, 0.0, 0.0, 0.0}, seed);
    detector.evaluate(1);  // before anything is known of the first
    CHECK(detector.evidence(1, 0).p_value < 1e-6);
    evaluate_all(detector);
    const ChannelEvidence& wrong = detector.evidence(0, 0);
    CHECK(wrong.p_value < 1e-6);
    CHECK(std::abs(wrong.gain_error.value - 0.3) < 4.0 * wrong.gain_error.deviation);
    CHECK(detector.evidence(0, 1).p_value > 1e-4);
    CHECK(detector.evidence(1, 0).p_value > 1e-4);
    CHECK(detector.evidence(1, 1).p_value > 1e-4);
  }
}

TEST_CASE("a wrong channel is found behind another one that is wrong alike") {
  // Expected: what was put in. By the second CV's regression alone it is another error by far: its
  // residual follows that of the first as it does in noise.
  const Series plant;
  for (std::uint64_t seed = 100; seed < 1100; seed += 100) {
    CAPTURE(seed);
    MismatchDetector detector = watched(plant, {0.3, 0.0, 0.3, 0.0}, seed);
    detector.evaluate(1);
    const Estimate alone = detector.evidence(1, 0).gain_error;
    CHECK(std::abs(alone.value - 0.3) > 10.0 * alone.deviation);
    evaluate_all(detector);
    for (int cv = 0; cv < 2; ++cv) {
      CAPTURE(cv);
      const ChannelEvidence& wrong = detector.evidence(cv, 0);
      CHECK(wrong.p_value < 1e-6);
      CHECK(std::abs(wrong.gain_error.value - 0.3) < 4.0 * wrong.gain_error.deviation);
      CHECK(wrong.gain_error.deviation < 0.3);  // less than there is to be found
      CHECK(detector.evidence(cv, 1).p_value > 1e-4);
    }
    // An alarm is raised where it was seen first.
    CHECK(detector.evidence(0, 0).p_value_material < 1e-4);
    CHECK(detector.evidence(1, 0).p_value_material > 1e-2);
  }
}

TEST_CASE("judging CVs together allocates nothing") {
  const Series plant;
  MismatchDetector detector = watched(plant, {0.3, 0.0, 0.0, 0.0}, 100);
  evaluate_all(detector);
  const std::uint64_t before = test::allocation_count();
  for (int cv = 0; cv < 2; ++cv) detector.evaluate(cv);
  CHECK(test::allocation_count() == before);
}

namespace {

// Rows of both CVs, and their factors.
struct Rows {
  explicit Rows(const Series& plant, const ModelSpec& error, std::uint64_t seed)
      : shape(plant.shape), residuals(kSamples, 2), inputs(kSamples, 2) {
    RegressionHistory history(shape, 10);
    LinearModel wrong(error);
    Noise noise;
    for (int cv = 0; cv < 2; ++cv) factors.emplace_back(shape.columns(), 1);
    for (std::int64_t k = 0; k < kSamples; ++k) {
      inputs.row(k) = plant.inputs(seed, k);
      residuals.row(k) = noise.value + wrong.output();
      history.push(inputs.row(k).transpose(), residuals.row(k).transpose());
      for (int cv = 0; cv < 2 && k >= kFirst; ++cv) {
        GivensQr& factor = factors[static_cast<std::size_t>(cv)];
        history.fill(cv, 0, factor.row());
        factor.row()[shape.columns()] = residuals(k, cv);
        factor.update(1.0);
      }
      wrong.advance(inputs.row(k).transpose());
      noise.advance(seed, k);
    }
  }
  [[nodiscard]] EstimateNoise noise(int cv) const {
    const double freedom = static_cast<double>(kSamples - kFirst) - shape.columns();
    const double variance = factors[static_cast<std::size_t>(cv)].residual_square(0) / freedom;
    return {variance, variance, freedom};
  }

  static constexpr Eigen::Index kSamples = 1500, kFirst = 200;
  RegressionShape shape;
  Eigen::MatrixXd residuals, inputs;
  std::vector<GivensQr> factors;
};

// Of the residual of least squares of column 0 on all others.
double left(const Eigen::MatrixXd& rows) {
  const Eigen::MatrixXd columns = rows.rightCols(rows.cols() - 1);
  const Eigen::VectorXd y = rows.col(0);
  return (y - columns * columns.householderQr().solve(y)).squaredNorm();
}

}  // namespace

TEST_CASE("what the errors of two CVs leave is what batch fits beside the noise's lags leave") {
  // Expected: the errors' outputs simulated and subtracted, then least squares by Eigen on the
  // lags and means of what is left.
  Series plant;
  plant.shape.residual_poles = {std::exp(-1.0 / 8.0)};
  ModelSpec error = plant.spec;
  for (const std::size_t c : {1u, 2u, 3u})
    std::get<TransferFunction>(error.channels[c].dynamics).gain *= c == 2 ? 0.2 : 0.0;
  std::get<TransferFunction>(error.channels[0].dynamics).gain *= 0.3;
  const Rows rows(plant, error, 40);
  const LinearModel model(plant.spec);
  const std::vector<ChannelSignatures> signatures = channel_signatures(rows.shape, model);
  const BlockBasis basis(rows.shape.fir_lags, rows.shape.tail_poles);
  Eigen::MatrixXd noise = rows.residuals;
  double expected = 0.0, said = 0.0;
  for (int cv = 0; cv < 2; ++cv) {
    InputEstimates estimates(rows.shape);
    estimates.read(cv, rows.factors[static_cast<std::size_t>(cv)]);
    CoupledErrors coupled(rows.shape);
    for (const int member : {cv, 1 - cv})
      coupled.add(member, rows.factors[static_cast<std::size_t>(member)], rows.noise(member));
    REQUIRE(coupled.fit(signatures, estimates));
    said = coupled.left_square();
    for (int input = 0; input < 2; ++input) {
      const InputErrors::Channel& channel = coupled.channel(input);
      const Eigen::VectorXd sizes =
          channel.usual.triangularView<Eigen::Upper>().solve(channel.estimate);
      const Eigen::VectorXd pulse = model.impulse_response(cv, input, basis.length());
      const std::vector<Eigen::VectorXd> errors = usual_errors(pulse, false);
      for (Eigen::Index k = 0; k < noise.rows(); ++k)
        for (std::size_t e = 0; e < errors.size(); ++e)
          for (Eigen::Index l = 1; l < std::min<Eigen::Index>(errors[e].size(), k + 1); ++l)
            noise(k, cv) -=
                sizes(static_cast<Eigen::Index>(e)) * errors[e](l) * rows.inputs(k - l, input);
    }
  }
  // In the variance of the second CV, which was the first of the last fit.
  for (int cv = 0; cv < 2; ++cv) {
    Eigen::MatrixXd columns(Rows::kSamples - Rows::kFirst, 1 + 1 + 2 * 3 + 1);
    double mean = 0.0;
    std::vector<double> means;
    for (Eigen::Index k = 0; k < Rows::kSamples; ++k) {
      mean += (1.0 - rows.shape.residual_poles[0]) * (noise(k, cv) - mean);
      means.push_back(mean);
    }
    for (Eigen::Index k = Rows::kFirst; k < Rows::kSamples; ++k) {
      auto row = columns.row(k - Rows::kFirst);
      row(0) = noise(k, cv);
      row(1) = 1.0;
      for (int other = 0; other < 2; ++other)
        for (int l = 1; l <= 3; ++l) row(1 + 3 * other + l) = noise(k - l, other);
      row(8) = means[static_cast<std::size_t>(k - 4)];
    }
    const double scale = rows.noise(1).variance / rows.noise(cv).variance;
    expected +=
        scale * (left(columns) - rows.factors[static_cast<std::size_t>(cv)].residual_square(0));
  }
  CHECK(said == Approx(expected).epsilon(0.02));
}

// Expected: two and three CVs of a plant's usual size take less than `kMostWork`; the work grows
// with the cube of the inputs and of the CVs that are judged together.
TEST_CASE("of a large unit fewer CVs are judged together, of a larger one none") {
  const auto shape = [](int inputs, int cvs) { return RegressionShape{inputs, cvs, 20, 8, {0.9}}; };
  const auto most = [&](int inputs, int cvs) {
    return CoupledErrors::most_cvs(shape(inputs, cvs));
  };
  CHECK(most(3, 3) == 3);
  CHECK(most(2, 1) == 1);
  CHECK(most(10, 20) == 3);
  CHECK(most(20, 20) == 2);
  CHECK(most(40, 40) == 1);
  CHECK(CoupledErrors::work_of(shape(20, 20), 2) < calibration::coupled_errors::kMostWork);
  CHECK(CoupledErrors::work_of(shape(20, 20), 3) > calibration::coupled_errors::kMostWork);
  const double doubled =
      CoupledErrors::work_of(shape(40, 20), 2) / CoupledErrors::work_of(shape(20, 20), 2);
  CHECK(doubled > 4.0);
  CHECK(doubled < 8.0);
}

}  // namespace mpm::coupled_errors_test
