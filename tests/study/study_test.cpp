#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/study/interval.hpp"
#include "tests/study/parallel.hpp"
#include "tests/study/report.hpp"
#include "tests/study/run.hpp"
#include "tests/study/summary.hpp"

namespace mpm::study {
namespace {

// Newcombe 1998, table I: 81 of 263 and 0 of 20.
TEST_CASE("Wilson's interval") {
  const Interval many = wilson(81, 263);
  CHECK(many.low == Approx(0.2553).margin(5e-5));
  CHECK(many.high == Approx(0.3662).margin(5e-5));
  const Interval none = wilson(0, 20);
  CHECK(none.low == 0.0);
  CHECK(none.high == Approx(0.1611).margin(5e-5));
}

// Garwood 1936: 95 % limits of a count of 1 and of 10.
TEST_CASE("interval of a Poisson mean") {
  CHECK(poisson(0).high == Approx(-std::log(0.05)));
  CHECK(poisson(1).low == Approx(0.0253).margin(5e-5));
  CHECK(poisson(1).high == Approx(5.572).margin(5e-4));
  CHECK(poisson(10).low == Approx(4.795).margin(5e-4));
  CHECK(poisson(10).high == Approx(18.39).margin(5e-3));
}

TEST_CASE("binomial tails by hand") {
  CHECK(binomial_at_least(2, 3, 0.5) == Approx(0.5));
  CHECK(binomial_at_most(0, 4, 0.1) == Approx(0.6561));
  CHECK(binomial_at_least(0, 4, 0.1) == Approx(1.0));
  CHECK(binomial_at_least(1, 1000, 1e-6) == Approx(1e-3).epsilon(1e-3));
}

TEST_CASE("runs whose trials go together count as fewer trials") {
  // Each run all or nothing: 10 trials are worth one.
  std::vector<Count> together, apart;
  for (int run = 0; run < 100; ++run) {
    together.push_back({run % 4 == 0 ? 10 : 0, 10});
    apart.push_back({run % 2 == 0 ? 2 : 3, 10});
  }
  CHECK(share_of(together).design_effect == Approx(10.0));
  CHECK(share_of(apart).design_effect == 1.0);
  CHECK(share_of(together).rate() == Approx(0.25));
  std::vector<Count> single(30, Count{0, 1});
  single[3].hits = single[7].hits = 1;
  CHECK(share_of(single).design_effect == Approx(1.0));
  const std::vector<Count> silent(50, Count{0, 200});
  CHECK(share_of(silent, Within::kOneTrial).independent_trials() == Approx(50.0));
  CHECK(share_of(silent).independent_trials() == Approx(10000.0));
}

TEST_CASE("what never happened is the largest value") {
  const double never = std::numeric_limits<double>::infinity();
  CHECK(quantile({5.0, never, 1.0}, 0.5) == 5.0);
  CHECK(std::isinf(quantile({5.0, never, never}, 0.5)));
}

TEST_CASE("a part between markers is replaced, and again to the same text") {
  const std::string text =
      "before\n<!-- study:begin a -->\nold\n<!-- study:end a -->\nafter\n"
      "<!-- study:begin b -->\nother\n<!-- study:end b -->\n";
  const std::string once = replace_part(text, "a", "new\n");
  CHECK(once ==
        "before\n<!-- study:begin a -->\nnew\n<!-- study:end a -->\nafter\n"
        "<!-- study:begin b -->\nother\n<!-- study:end b -->\n");
  CHECK(replace_part(once, "a", "new\n") == once);
  CHECK_THROWS_AS(replace_part(text, "c", "new\n"), std::invalid_argument);
}

Experiment half_wrong() {
  Experiment experiment;
  experiment.name = "half_wrong";
  experiment.samples = 900;
  experiment.also_at = {600};
  experiment.seeds = {1, 3};
  experiment.changes = {{.cv = 1, .input = 2, .gain_ratio = 0.5, .from_s = 650.0},
                        {.cv = 0, .input = 0, .gain_ratio = 1.02}};
  experiment.material = 0.1;
  return experiment;
}

TEST_CASE("truth follows the changes, and the number of threads changes nothing") {
  std::string why_not;
  const std::optional<Prepared> prepared = prepare(half_wrong(), why_not);
  REQUIRE(prepared);
  const std::vector<RunRecord> alone = run_all(*prepared, 1, "");
  const std::vector<RunRecord> shared = run_all(*prepared, 3, "");
  REQUIRE(alone.size() == 3);
  const std::size_t wrong = 2 * 3 + 1;  // u3 -> y2
  CHECK(alone[0].readings[0][wrong].truth == Truth::kHealthy);
  CHECK(alone[0].readings[1][wrong].truth == Truth::kWrong);
  CHECK(alone[0].truth[wrong].first(Truth::kWrong) == 650);
  CHECK(alone[0].readings[1][0].truth == Truth::kSmall);
  CHECK(alone[0].readings[1][1].truth == Truth::kHealthy);
  CHECK(alone[0].readings[1][0].p_value != alone[1].readings[1][0].p_value);

  const Experiment experiment = half_wrong();
  CHECK(to_json({summarise(experiment, alone)}) == to_json({summarise(experiment, shared)}));
}

TEST_CASE("bounds break only where chance hardly could") {
  Summary summary;
  summary.experiment.bounds = {{"rate", 0, Bound::Side::kAtMost, 0.01}};
  const auto broken = [&](std::int64_t hits, Bound::Side side, double rate) {
    summary.experiment.bounds[0].side = side;
    summary.experiment.bounds[0].rate = rate;
    summary.metrics = {{"rate", 0, Share{hits, 1000, 1.0, {}}}};
    return !check_bounds(summary)[0].kept;
  };
  // Binomial(1000, 0.01): P(X >= 23) = 3e-4, P(X >= 25) = 5e-5.
  CHECK_FALSE(broken(23, Bound::Side::kAtMost, 0.01));
  CHECK(broken(25, Bound::Side::kAtMost, 0.01));
  CHECK_FALSE(broken(977, Bound::Side::kAtLeast, 0.99));
  CHECK(broken(970, Bound::Side::kAtLeast, 0.99));
  CHECK_FALSE(broken(1000, Bound::Side::kAtLeast, 0.99));
  summary.metrics.clear();
  CHECK_FALSE(check_bounds(summary)[0].kept);
}

TEST_CASE("every experiment of a table exists") {
  for (const Study& study : {full_study(), short_study()}) {
    std::vector<std::string> names;
    for (const Experiment& experiment : study.experiments) names.push_back(experiment.name);
    std::sort(names.begin(), names.end());
    CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
    for (const Table& table : study.tables)
      for (const std::string& pattern : table.experiments)
        CHECK(std::any_of(names.begin(), names.end(),
                          [&](const std::string& name) { return matches(pattern, name); }));
  }
}

}  // namespace
}  // namespace mpm::study
