#include "core/mismatch/lagged_correlation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::lagged_correlation_test {
namespace {

struct Signals {
  Eigen::VectorXd u, e;
};

// Twin of `signals` in tests/oracles/lagged_correlation.py.
void draw(int inputs, int cvs, double collinear, std::int64_t k, Signals& out) {
  for (int i = 0; i < inputs; ++i) out.u(i) = test::coloured(static_cast<std::uint64_t>(10 + i), k);
  if (collinear > 0.0) out.u(inputs - 1) = out.u(0) + out.u(1) + collinear * out.u(inputs - 1);
  for (int j = 0; j < cvs; ++j) {
    const auto s = static_cast<std::uint64_t>(j);
    out.e(j) = 0.3 * test::coloured(10 + s, k - 2) - 0.2 * test::coloured(11 + s, k - 5) +
               test::coloured(50 + s, k);
  }
}

CorrelationKind kind_of(const std::string& name) {
  if (name == "conventional") return CorrelationKind::kConventional;
  if (name == "partial") return CorrelationKind::kPartial;
  if (name == "alternative") return CorrelationKind::kAlternative;
  REQUIRE(name == "lagged_partial");
  return CorrelationKind::kLaggedPartial;
}

LaggedCorrelation::Shape shape_of(const nlohmann::json& json) {
  return {json["inputs"],    json["cvs"],      json["controlling_lags"],
          json["first_lag"], json["last_lag"], kind_of(json["kind"])};
}

CorrelationKind any_kind() {
  return GENERATE(CorrelationKind::kLaggedPartial, CorrelationKind::kPartial,
                  CorrelationKind::kConventional, CorrelationKind::kAlternative);
}

TEST_CASE("recursive correlations of every kind equal batch least squares") {
  // Expected: tests/oracles/lagged_correlation.py (numpy lstsq, SVD, refined once).
  const nlohmann::json oracle = test::read_oracle("lagged_correlation.json");
  for (const nlohmann::json& json : oracle["cases"]) {
    DYNAMIC_SECTION(json["name"].get<std::string>()) {
      const LaggedCorrelation::Shape shape = shape_of(json);
      LaggedCorrelation correlation(shape, json["lambda"]);
      Signals signals{Eigen::VectorXd(shape.inputs), Eigen::VectorXd(shape.cvs)};
      const std::int64_t samples = json["samples"];
      for (std::int64_t k = 0; k < samples; ++k) {
        draw(shape.inputs, shape.cvs, json["collinear"], k, signals);
        correlation.update(signals.u, signals.e);
      }
      correlation.evaluate();
      double largest = 0.0;
      for (int i = 0; i < shape.inputs; ++i) {
        CHECK(correlation.defined(i));
        const nlohmann::json& expected = json["expected"][static_cast<std::size_t>(i)];
        for (int j = 0; j < shape.cvs; ++j) {
          for (int l = 0; l < correlation.lag_count(); ++l) {
            const double value =
                expected[static_cast<std::size_t>(j * correlation.lag_count() + l)];
            largest = std::max(largest, std::abs(correlation.correlations(j, i)(l) - value));
          }
        }
      }
      INFO("largest difference " << largest);
      CHECK(largest < json["tolerance"].get<double>());
    }
  }
}

TEST_CASE("a silent input has no correlation and does not disturb the others") {
  const CorrelationKind kind = any_kind();
  const LaggedCorrelation::Shape with{3, 1, 5, -2, 4, kind};
  const LaggedCorrelation::Shape without{2, 1, 5, -2, 4, kind};
  LaggedCorrelation three(with, 0.99);
  LaggedCorrelation two(without, 0.99);
  Signals signals{Eigen::VectorXd(3), Eigen::VectorXd(1)};
  for (int k = 0; k < 2000; ++k) {
    draw(3, 1, 0.0, k, signals);
    signals.u(2) = 17.3;
    three.update(signals.u, signals.e);
    two.update(signals.u.head(2), signals.e);
  }
  three.evaluate();
  two.evaluate();
  CHECK_FALSE(three.defined(2));
  CHECK(three.correlations(0, 2).isZero(0.0));
  for (int i = 0; i < 2; ++i) {
    CHECK(three.defined(i));
    CHECK((three.correlations(0, i) - two.correlations(0, i)).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("exactly collinear inputs are undefined, never NaN") {
  const CorrelationKind kind = any_kind();
  const bool controlled = kind != CorrelationKind::kConventional;
  LaggedCorrelation correlation({3, 2, 10, -5, 8, kind}, 0.999);
  Signals signals{Eigen::VectorXd(3), Eigen::VectorXd(2)};
  for (int k = 0; k < 3000; ++k) {
    draw(3, 2, 0.0, k, signals);
    signals.u(2) = 2.0 * signals.u(0);
    correlation.update(signals.u, signals.e);
    correlation.evaluate();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 2; ++j) {
        const Eigen::Ref<const Eigen::VectorXd> values = correlation.correlations(j, i);
        REQUIRE(values.allFinite());
        REQUIRE(values.cwiseAbs().maxCoeff() <= 1.0 + 1e-12);
      }
  }
  CHECK(correlation.defined(0) != controlled);
  CHECK(correlation.defined(1));
  CHECK(correlation.defined(2) != controlled);
}

TEST_CASE("a closed window leaves no row that spans the gap") {
  // Two halves of one record with a gap between must give what the rows of the halves give: the
  // gap's correlation would show up at once because the second half is shifted by 1000.
  const LaggedCorrelation::Shape shape{2, 1, 4, -1, 3, any_kind()};
  LaggedCorrelation gapped(shape, 1.0);
  Signals signals{Eigen::VectorXd(2), Eigen::VectorXd(1)};
  const auto run = [&](LaggedCorrelation& into, int begin, int end, double offset) {
    for (int k = begin; k < end; ++k) {
      draw(2, 1, 0.0, k, signals);
      signals.e.array() += offset;
      into.update(signals.u, signals.e);
    }
  };
  run(gapped, 0, 400, 0.0);
  gapped.close_window();
  run(gapped, 400, 404, 1000.0);  // fewer than a window: no row of these
  gapped.close_window();
  run(gapped, 500, 900, 0.0);
  gapped.evaluate();

  LaggedCorrelation halves(shape, 1.0);
  run(halves, 0, 400, 0.0);
  halves.close_window();
  run(halves, 500, 900, 0.0);
  halves.evaluate();
  for (int i = 0; i < 2; ++i)
    CHECK((gapped.correlations(0, i) - halves.correlations(0, i)).isZero(0.0));
}

TEST_CASE("a correlation of any kind allocates nothing per sample") {
  LaggedCorrelation correlation({3, 3, 40, -10, 20, any_kind()}, 0.999);
  Signals signals{Eigen::VectorXd(3), Eigen::VectorXd(3)};
  const std::uint64_t before = test::allocation_count();
  for (int k = 0; k < 300; ++k) {
    draw(3, 3, 0.0, k, signals);
    correlation.update(signals.u, signals.e);
    correlation.evaluate();
  }
  CHECK(test::allocation_count() == before);
}

}  // namespace
}  // namespace mpm::lagged_correlation_test
