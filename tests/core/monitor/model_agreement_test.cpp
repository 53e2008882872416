#include "core/monitor/model_agreement.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::model_agreement_test {
namespace {

using Eigen::VectorXd;

constexpr Eigen::Index kRows = 6000;

VectorXd input() { return test::telegraph(1, kRows, 15); }

/// How often it is said in 6000 samples that the predictions are another model's.
int said(const VectorXd& predicted, const VectorXd& simulated) {
  ModelAgreement agreement;
  int count = 0;
  for (Eigen::Index k = 0; k < kRows; ++k) {
    agreement.take(predicted(k), simulated(k));
    count += agreement.differs() ? 1 : 0;
  }
  return count;
}

}  // namespace

// The s.d. of the difference, in that of the model's answer: 0.3 of the gain; of the dead time
// 0.54, of the lag 0.38 (means of 20 telegraphs of another generator; 0.36 at least).
TEST_CASE("predictions of another gain, dead time or lag are told after three blocks") {
  const VectorXd model = test::first_order(input(), 2.0, 20.0, 3);
  CHECK(said(test::first_order(input(), 2.6, 20.0, 3), model) == kRows - 1499);
  CHECK(said(test::first_order(input(), 2.0, 20.0, 11), model) == kRows - 1499);
  CHECK(said(test::first_order(input(), 2.0, 40.0, 3), model) == kRows - 1499);
  CHECK(said(VectorXd::Zero(kRows), model) == kRows - 1499);
}

// Of a sample more 0.08, of a tenth of the gain 0.1; of the digits 0.5 / sqrt(12) to an s.d.
// of 1.1.
TEST_CASE("digits, levels, a deadband and a sample more or less make no other model") {
  const VectorXd model = 100.0 + test::first_order(input(), 2.0, 20.0, 3).array();
  CHECK(said(model.array() + 5.0, model) == 0);
  CHECK(said((model.array() / 0.5).round() * 0.5, model) == 0);
  CHECK(said(test::first_order(input(), 2.0, 20.0, 4), model) == 0);
  CHECK(said(test::first_order(input(), 2.2, 20.0, 3), model) == 0);
  VectorXd held = model;
  for (Eigen::Index k = 1; k < kRows; ++k)
    if (std::abs(held(k) - held(k - 1)) < 0.3) held(k) = held(k - 1);
  CHECK(said(held, model) == 0);
  // A rest, in which the last digits are all that there is.
  VectorXd calm = model;
  calm.tail(3000).setConstant(100.0);
  CHECK(said(calm + 0.05 * test::white(2, kRows), calm) == 0);
}

TEST_CASE(
    "it is over once three blocks agree, and nothing is learnt where nothing is to be trusted") {
  const VectorXd model = test::first_order(input(), 2.0, 20.0, 3);
  ModelAgreement agreement;
  for (Eigen::Index k = 0; k < 3000; ++k) agreement.take(2.0 * model(k), model(k));
  CHECK(agreement.differs());
  for (Eigen::Index k = 3000; k < 4499; ++k) agreement.take(model(k), model(k));
  CHECK(agreement.differs());
  agreement.take(model(4499), model(4499));
  CHECK_FALSE(agreement.differs());
  for (Eigen::Index k = 0; k < kRows; ++k) {
    if (k % 400 == 0) agreement.skip();
    agreement.take(2.0 * model(k), model(k));
  }
  CHECK_FALSE(agreement.differs());
}

}  // namespace mpm::model_agreement_test
