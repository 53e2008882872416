#include "core/nonlinear/nonlinear_detector.hpp"

#include <catch2/catch.hpp>

#include "tests/allocation_counter.hpp"
#include "tests/core/nonlinear/bent_plant.hpp"

namespace mpm {

TEST_CASE("the verdict is open at first, then linear or nonlinear") {
  for (const double square : {0.0, 0.1}) {
    NonlinearVerdict early = NonlinearVerdict::kLinear, late = NonlinearVerdict::kUndetermined;
    test::BentPlant plant{.seed = 11, .square = square};
    plant.follow([&](int k, MismatchDetector& linear, NonlinearDetector& nonlinear) {
      if (k != 100 && k + 1 != plant.samples) return;
      linear.fold(0);
      nonlinear.evaluate(0, linear);
      (k == 100 ? early : late) = nonlinear.result(0, 0).verdict;
    });
    CHECK(early == NonlinearVerdict::kUndetermined);
    CHECK(late == (square > 0.0 ? NonlinearVerdict::kNonlinear : NonlinearVerdict::kLinear));
  }
}

TEST_CASE("between its beginnings the nonlinear test allocates nothing") {
  int allocating = 0;
  std::uint64_t before = 0;
  test::BentPlant plant{.seed = 12};
  plant.follow([&](int k, MismatchDetector& linear, NonlinearDetector& nonlinear) {
    allocating += k > 0 && test::allocation_count() != before ? 1 : 0;
    if (k % 5 == 4) nonlinear.evaluate(0, linear);
    before = test::allocation_count();
  });
  // It begins once there are five rows for each of 5 + 26 linear columns, and whenever these have
  // doubled until there are 2500: four times at most.
  CHECK(allocating <= 4);
}

TEST_CASE("a fresh start of the linear test is one of the nonlinear test, too") {
  test::BentPlant plant{.seed = 13, .square = 0.1};
  plant.follow([&](int k, MismatchDetector& linear, NonlinearDetector& nonlinear) {
    if (k == 1500) linear.start_afresh(0, 50);
    if (k == 1550) {
      linear.fold(0);
      nonlinear.evaluate(0, linear);
      CHECK(nonlinear.result(0, 0).verdict == NonlinearVerdict::kUndetermined);
      CHECK(nonlinear.result(0, 0).p_value == 1.0);
    }
  });
}

TEST_CASE("what was found bent stays so after a fresh start until it can be asked anew") {
  const bool mended = GENERATE(false, true);
  test::BentPlant plant{.seed = 13, .square = 0.1, .samples = 3000};
  plant.follow([&](int k, MismatchDetector& linear, NonlinearDetector& nonlinear) {
    if (k == 1449 && mended) plant.square = 0.0;
    if (k == 1450) linear.start_afresh(0, 50);
    if (k != 1449 && k != 1500 && k != 2999) return;
    linear.fold(0);
    nonlinear.evaluate(0, linear);
    CAPTURE(mended, k);
    CHECK(nonlinear.result(0, 0).verdict ==
          (k == 2999 && mended ? NonlinearVerdict::kLinear : NonlinearVerdict::kNonlinear));
    if (k == 1500) CHECK(nonlinear.result(0, 1).verdict == NonlinearVerdict::kUndetermined);
    if (k != 2999) return;
    nonlinear.silence(0);
    CHECK(nonlinear.result(0, 0).verdict == NonlinearVerdict::kUndetermined);
  });
}

TEST_CASE("a test that is off says that it is") {
  const RegressionShape shape{2, 1, 12, 4, {0.9355}};
  const LinearModel model(test::BentPlant::spec());
  const NonlinearDetector off(shape, model, {});
  CHECK_FALSE(off.on());
  CHECK_FALSE(off.result(0, 1).tested);
  CHECK(off.result(0, 1).verdict == NonlinearVerdict::kUndetermined);
}

}  // namespace mpm
