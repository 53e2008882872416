#include "daemon/history/digest_json.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {

TEST_CASE("a digest comes back from its line as it was") {
  Digest digest = test::sample_digest(test::kMonday, 12.5, 0.3);
  digest.channels[0].reason = "collinear";
  digest.channels[0].confounder = "u2";
  const std::string line = line_of("sample", digest);
  CHECK(line.find(R"({"record":"digest","unit":"sample","time_ns":1767571200000000000,)") == 0);
  const Digest back = digest_of(nlohmann::json::parse(line));
  CHECK(line_of("sample", back) == line);
  CHECK(back.samples == 15);
  CHECK(back.cvs.at(0).prediction_rms == 0.3);
  CHECK(back.channels.at(0).confounder == "u2");
  CHECK(back.channels.at(0).low == 10.5);
}

TEST_CASE("what is not known is left out of a line, and not known when it comes back") {
  Digest digest = test::sample_digest(test::kMonday, kUnknown, 0.3);
  const std::string line = line_of("sample", digest);
  CHECK(line.find("gain_error") == std::string::npos);
  CHECK(line.find("null") == std::string::npos);
  CHECK_FALSE(known(digest_of(nlohmann::json::parse(line)).channels.at(0).gain_error));
}

TEST_CASE("a head comes back from its line, and a line of something else does not") {
  const UnitHead head = test::sample_head();
  const UnitHead back = head_of(nlohmann::json::parse(line_of(head)));
  CHECK(line_of(back) == line_of(head));
  CHECK(back.channels.at(0).gain_limit == 0.05);
  CHECK_THROWS_AS(head_of(nlohmann::json::parse(R"({"record":"journal"})")),
                  nlohmann::json::exception);
  CHECK_THROWS_AS(digest_of(nlohmann::json::parse(R"({"time_ns":"x"})")),
                  nlohmann::json::exception);
}

}  // namespace mpm::history
