#include "daemon/report/performance_text.hpp"

#include <catch2/catch.hpp>

#include "tests/idl/fixed_records.hpp"

namespace mpm::report {
namespace {

// The numbers are those of the record; the variance is 0.25, so the s.d. 0.5.
TEST_CASE("control performance is told in columns, with dashes for what is not known") {
  PerformanceRecord record = test::performance();
  record.cvs[1].prediction = {{1, std::nan(""), std::nan("")}, {90, 0.5, 1.5}};
  CHECK(performance_text(record, {}) ==
        "Control performance\n"
        "  599 samples; the controller acts in 94 % of them\n"
        "\n"
        "  CV  mean error  s.d.  outside\n"
        "  y1      -0.125   0.5    6.2 %\n"
        "  y2          --    --       --\n"
        "\n"
        "  CV    1 ahead   90 ahead\n"
        "  y1  0.1 / 0.2  0.3 / 0.7\n"
        "  y2    -- / --  0.5 / 1.5\n"
        "  RMS error of predictions so many samples ahead / what the CV itself moved\n"
        "\n"
        "  MV  at low  at high  travel  standing\n"
        "  u1     1 %      2 %    0.75      50 %\n"
        "  u2      --       --      --        --\n"
        "  travel: mean absolute move per sample\n");
}

TEST_CASE("whatever tags there are, no line of the tables grows beyond the screen") {
  PerformanceRecord record = test::performance();
  record.cvs[0].cv = record.mvs[0].mv = std::string(100, 'x');
  record.cvs[0].prediction = {{1, 0.00012, 0.00034}, {7200, 123.4, 567.8}, {14400, 0.01, 0.02}};
  std::size_t width = 0;
  for (const char c : performance_text(record, {})) {
    width = c == '\n' ? 0 : width + 1;
    CHECK(width <= 80);
  }
}

}  // namespace
}  // namespace mpm::report
