#include "core/nonlinear/channel_path.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/channel_model.hpp"

namespace mpm::channel_path_test {
namespace {

LinearModel model() {
  return LinearModel(test::channel_model(3, 1,
                                         {{0, 0, TransferFunction{2.0, {10.0}, 0, 3, false}},
                                          {0, 1, TransferFunction{0.1, {}, 0, 0, true}}}));
}

}  // namespace

TEST_CASE("a path answers as the model's channel does") {
  // First-order lag with dead time: a step at k shows at k + 4 (dead time 3, one sample for the
  // hold) as 2 (1 - exp(-1 / 10)).
  ChannelPath path(model(), 0, 0, 0.9);
  path.rest(0.0);
  for (int k = 0; k < 4; ++k) {
    CHECK(path.output() == 0.0);
    path.advance(1.0);
  }
  CHECK(path.output() == Approx(2.0 * (1.0 - std::exp(-0.1))));
  path.rest(1.5);
  CHECK(path.output() == Approx(3.0));
}

TEST_CASE("a mean stands for a channel that integrates or is none") {
  for (const int input : {1, 2}) {
    ChannelPath path(model(), 0, input, 0.9);
    path.rest(1.0);
    CHECK(path.output() == 1.0);
    path.advance(2.0);
    CHECK(path.output() == Approx(0.9 + 0.1 * 2.0));
  }
}

}  // namespace mpm::channel_path_test
