#include "core/mismatch/volterra_terms.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::volterra_terms_test {
namespace {

constexpr int kDepth = 300;

// Three channels, one of which integrates, and one input that the CV does not know.
ModelSpec some_channels() {
  return test::channel_model(4, 1,
                             {{0, 0, TransferFunction{1.0, {4.0}, 0, 1, false}},
                              {0, 1, TransferFunction{-3.0, {9.0}, 0, 0, false}},
                              {0, 2, TransferFunction{0.1, {}, 0, 0, true}}});
}

Eigen::VectorXd moves(int k) {
  Eigen::VectorXd u(4);
  for (int i = 0; i < 4; ++i) u(i) = test::uniform(static_cast<std::uint64_t>(i), k / 7);
  return u;
}

RegressionHistory history_of(int samples) {
  RegressionHistory history({4, 1, 5, 2, {0.9}}, kDepth);
  for (int k = 0; k < samples; ++k) history.push(moves(k), Eigen::VectorXd::Zero(1));
  return history;
}

}  // namespace

TEST_CASE("Volterra terms are the products and cubes of what the model's channels give") {
  const LinearModel model(some_channels());
  RegressionHistory history = history_of(400);
  VolterraTerms terms(model, 0, history, kDepth);
  // Without the one that integrates and the one that is none; the larger movement first.
  REQUIRE(terms.inputs() == std::vector<int>{1, 0});
  CHECK(terms.columns() == 2 * (3 + 2));  // two samples of 1.1, 1.0, 0.0 and two cubes
  CHECK(terms.columns() <= VolterraTerms::most_columns());

  // The same channels, run from the start of the data: what the start left is long gone.
  std::vector<LinearModel> channels = {model.channel(0, 1), model.channel(0, 0)};
  std::vector<std::vector<double>> g(2);
  const auto step = [&](int k) {
    for (std::size_t a = 0; a < 2; ++a) {
      g[a].push_back(channels[a].output()(0));
      channels[a].advance(Eigen::VectorXd::Constant(1, moves(k)(a == 0 ? 1 : 0)));
    }
  };
  for (int k = 0; k < 400; ++k) step(k);
  for (int k = 400; k < 410; ++k) {  // and what comes after they were made
    history.push(moves(k), Eigen::VectorXd::Zero(1));
    terms.push(history);
    step(k);
  }
  std::vector<double> row(static_cast<std::size_t>(terms.columns()));
  for (const int age : {0, 5, 100}) {
    terms.fill(age, row.data());
    const std::size_t now = 409 - static_cast<std::size_t>(age);
    for (std::size_t lag = 0; lag < 2; ++lag) {
      const double a = g[0][now - lag], b = g[1][now - lag];
      CAPTURE(age, lag);
      const auto at = [&](const std::array<int, 2>& columns) {
        return row[static_cast<std::size_t>(columns[lag])];
      };
      CHECK(at(terms.product_columns(0, 0)) == Approx(a * a).margin(1e-9));
      CHECK(at(terms.product_columns(0, 1)) == Approx(a * b).margin(1e-9));
      CHECK(at(terms.product_columns(1, 1)) == Approx(b * b).margin(1e-9));
      CHECK(at(terms.cube_columns(0)) == Approx(a * a * a).margin(1e-9));
      CHECK(at(terms.cube_columns(1)) == Approx(b * b * b).margin(1e-9));
    }
  }
}

TEST_CASE("each column of the Volterra terms belongs to what it is made of") {
  const VolterraTerms terms(LinearModel(some_channels()), 0, history_of(400), kDepth);
  std::set<int> own;
  for (const auto& columns :
       {terms.product_columns(0, 0), terms.product_columns(0, 1), terms.product_columns(1, 1),
        terms.cube_columns(0), terms.cube_columns(1)})
    own.insert(columns.begin(), columns.end());
  CHECK(own.size() == static_cast<std::size_t>(terms.columns()));
  for (const int column : terms.product_columns(0, 1)) {
    CHECK(terms.has(column, 0));
    CHECK(terms.has(column, 1));
  }
  CHECK_FALSE(terms.has(terms.cube_columns(0)[1], 1));
  CHECK_FALSE(terms.has(terms.product_columns(1, 1)[0], 0));
}

TEST_CASE("where the operating point was never passed the middle of what was stands for it") {
  RegressionHistory history({1, 1, 5, 2, {0.9}}, kDepth);
  for (int k = 0; k < 400; ++k)
    history.push(Eigen::VectorXd::Constant(1, k % 40 < 20 ? 30.0 : 50.0), Eigen::VectorXd::Zero(1));
  const ModelSpec spec =
      test::channel_model(1, 1, {{0, 0, TransferFunction{1.0, {0.5}, 0, 0, false}}});
  const VolterraTerms terms(LinearModel(spec), 0, history, kDepth);
  // About 40, so +-10; about the operating point, 0, it would be 30 and 50.
  for (int age = 0; age < 100; ++age) CHECK(std::abs(terms.contribution(0, age)) < 10.0 + 1e-9);
}

}  // namespace mpm::volterra_terms_test
