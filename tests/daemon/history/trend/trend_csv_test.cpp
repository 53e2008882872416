#include "daemon/history/trend/trend_csv.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {

TEST_CASE("a trend as CSV has a row for each CV and channel of a period") {
  TrendMaker maker(Step::kHour, nullptr);
  UnitHead head = test::sample_head();
  head.channels[0].mv = "u,1";
  maker.add(head);
  for (int q = 0; q < 8; ++q) {
    Digest digest = test::sample_digest(test::kMonday + q * 900 * test::kSecond, 1.0, 0.25);
    digest.channels[0].mv = "u,1";
    if (q >= 4) digest.channels[0].gain_error = kUnknown;
    maker.add(digest);
  }
  CHECK(to_csv(maker.finish()) ==
        "from,until,mv,cv,samples,residual_rms,prediction_rms,movement_rms,fit_percent,match,"
        "mismatch,undetermined,excited,gain_error_percent,effect_size,low,high\n"
        "2026-01-05T00:00:00Z,2026-01-05T00:59:00Z,,y,60,0.125,0.25,4,93.75,,,,,,,,\n"
        "2026-01-05T00:00:00Z,2026-01-05T00:59:00Z,\"u,1\",y,60,,,,,1,0,0,1,1,,-1,3\n"
        "2026-01-05T01:00:00Z,2026-01-05T01:59:00Z,,y,60,0.125,0.25,4,93.75,,,,,,,,\n"
        "2026-01-05T01:00:00Z,2026-01-05T01:59:00Z,\"u,1\",y,60,,,,,1,0,0,1,,,,\n");
}

}  // namespace mpm::history
