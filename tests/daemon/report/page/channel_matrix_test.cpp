#include "daemon/report/page/channel_matrix.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test::channel_matrix_test {
namespace {

using Json = nlohmann::ordered_json;

TEST_CASE("an undetermined diagnosis shows nothing as good") {
  report::DiagnosisRun run = matching_run();
  run.diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  const Json matrix = report::matrix_json(run);
  for (const Json& row : matrix["rows"])
    for (const Json& cell : row["cells"]) CHECK(cell["state"] == "doubt");
}

}  // namespace
}  // namespace mpm::test::channel_matrix_test
