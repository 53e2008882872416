#include "daemon/history/trend/trend_text.hpp"

#include <catch2/catch.hpp>

#include "daemon/report/terminal/terminal_text.hpp"
#include "tests/daemon/history/sample_history.hpp"
#include "tests/system/process.hpp"

namespace mpm::history {

TEST_CASE("a trend as text has a row for each period, and gaps are told") {
  TrendMaker maker(Step::kDay, nullptr);
  maker.add(test::sample_head());
  for (int q = 0; q < 96 * 5; ++q) {
    if (q / 96 == 1) continue;  // no sample
    Digest digest = test::sample_digest(test::kMonday + q * 900 * test::kSecond,
                                        q / 96 >= 4 ? 12.0 : 1.0, 0.25);
    if (q / 96 == 2) digest.channels[0].gain_error = kUnknown;
    maker.add(digest);
  }
  const Trend trend = maker.finish();
  CHECK(to_text(trend, find_changes(trend), {}, nullptr) ==
        "sample: 5760 samples from 00:00 on 5 January 2026 to 23:59 on 9 January 2026\n"
        "  (UTC), by day\n"
        "\n"
        "Prediction errors 600 s ahead, RMS (and how much of the movement was predicted)\n"
        "             y\n"
        "  5 January  0.25 % (94 %)\n"
        "  ...        .\n"
        "  7 January  0.25 % (94 %)\n"
        "  8 January  0.25 % (94 %)\n"
        "  9 January  0.25 % (94 %)\n"
        "\n"
        "Gain errors, % of the model's (x mismatch, . not known)\n"
        "             u>y\n"
        "  5 January  +1 %\n"
        "  ...        .\n"
        "  7 January  .\n"
        "  8 January  +1 %\n"
        "  9 January  +12 % x\n"
        "\n"
        "Changes cannot be told: no series has 6 days that are known.\n");
}

TEST_CASE("no line of a trend is wider than the terminal, whatever the units") {
  TrendMaker maker(Step::kDay, nullptr);
  UnitHead head = test::sample_head();
  head.horizon_samples = 123'456;
  head.cvs[0].unit = "kg/(m2 s)";
  head.channels[0].modelled = false;
  maker.add(head);
  for (int q = 0; q < 96 * 2; ++q)
    maker.add(test::sample_digest(test::kMonday + q * 900 * test::kSecond, 1.0, 0.25));
  const Trend trend = maker.finish();
  for (const std::size_t width : {std::size_t{40}, std::size_t{60}, std::size_t{80}}) {
    const std::string text = to_text(trend, find_changes(trend), {width, false}, nullptr);
    for (const std::string& line : test::lines_of(text)) CHECK(report::columns_of(line) <= width);
    CHECK(text.find("0.25 kg/(m2 s) (94 %)") != std::string::npos);
    CHECK(text.find("1 kg/(m2 s) per t/h") != std::string::npos);
  }
}

}  // namespace mpm::history
