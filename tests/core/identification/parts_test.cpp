#include <catch2/catch.hpp>

#include "core/identification/channel_shape.hpp"
#include "core/identification/high_order.hpp"
#include "core/identification/residual_tests.hpp"
#include "tests/core/identification/loop.hpp"

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

TEST_CASE("blocks of lags follow each other without a gap") {
  for (const int longest : {1, 5, 40, 600}) {
    const std::vector<LagBlock> blocks = lag_blocks(longest);
    int next = 1;
    for (const LagBlock& block : blocks) {
      CHECK(block.first == next);
      CHECK(block.last >= block.first);
      next = block.last + 1;
    }
    CHECK(next == longest + 1);
  }
}

TEST_CASE("sums over blocks of lags are those of a plain loop, each run by itself") {
  const VectorXd u = white(901, 60);
  const std::vector<Run> runs = {{0, 25}, {25, 35}};
  const std::vector<LagBlock> blocks = {{1, 1}, {2, 2}, {3, 6}, {7, 15}};
  const MatrixXd sums = lagged_sums(u, blocks, runs);
  for (const Run& run : runs)
    for (Index k = run.first; k < run.first + run.count; ++k)
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        double sum = 0.0;
        for (Index l = blocks[b].first; l <= blocks[b].last; ++l)
          sum += u(std::max(run.first, k - l));
        CHECK(sums(k, static_cast<Index>(b)) == Approx(sum).margin(1e-12));
      }
}

TEST_CASE("a first-order channel answers as its difference equation does") {
  const VectorXd u = telegraph(902, 200, 13);
  ChannelShape shape;
  shape.gain = -2.5;
  shape.time_constant = 7.0;
  shape.dead_time = 3.0;
  const VectorXd y = response(shape, u, {{0, 200}});
  const VectorXd expected = first_order(u, -2.5, 7.0, 3);
  CHECK((y - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("residual tests are quiet where the model is right and loud where a channel is missing") {
  // Innovations are white and depend on nothing else: p is uniform, below 1e-3 once in a thousand.
  const IdentificationData data = identification_data(Loop().run(3000));
  ChannelShape first{0, ChannelForm::kFirstOrder, 2.0, 3.0, 15.0};
  ChannelShape second{1, ChannelForm::kFirstOrder, -1.0, 1.0, 6.0};
  const NoiseAssumption noise{{10, 0.0}, 1.0};
  const PredictionErrorFit right = fit_prediction_error(data, 0, {first, second}, noise, 20);
  CHECK(whiteness_p_value(right) > 1e-3);
  CHECK(past_input_p_value(data, right, 0) > 1e-3);
  CHECK(past_input_p_value(data, right, 1) > 1e-3);
  const PredictionErrorFit poor = fit_prediction_error(data, 0, {first}, noise, 20);
  CHECK(past_input_p_value(data, poor, 1) < 1e-9);
}

}  // namespace mpm::test
