#include "core/identification/identification_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("inputs are held where they are unknown, each run from its own first value") {
  Recording recording = recording_of(MatrixXd::Zero(6, 1), MatrixXd::Zero(6, 1));
  const double no = std::nan("");
  recording.inputs << 1, no, 3, no, 7, 9;
  recording.cvs << 2, no, 4, 6, 8, no;
  recording.borders = {{3, 0.0}};
  const IdentificationData data = identification_data(recording);
  CHECK(data.input_mean(0) == 5.0);  // (1 + 3 + 7 + 9) / 4
  VectorXd inputs(6), cvs(6), known(6);
  inputs << -4, -4, -2, 2, 2, 4;
  cvs << -3, 0, -1, 1, 3, 0;  // about 5
  known << 1, 0, 1, 1, 1, 0;
  CHECK(data.inputs.col(0) == inputs);
  CHECK(data.cvs.col(0) == cvs);
  CHECK(data.known.col(0) == known);
  CHECK(spread_of(data.cvs.col(0), data.known.col(0)) == Approx(std::sqrt(5.0)));
}

}  // namespace mpm::test
