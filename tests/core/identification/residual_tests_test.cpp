#include "core/identification/residual_tests.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
