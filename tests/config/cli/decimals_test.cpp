#include "config/cli/decimals.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace mpm::cli {
namespace {

struct Bench {
  Bench() {
    app.add_option("--seed", seed);
    app.add_option("--name", name);
    app.add_option("--count", count);
    CLI::App* command = app.add_subcommand("sub");
    command->add_option("--domain", domain)->check(CLI::Range(0, 230));
    command->add_option("--shift", shift);
    read_decimals(app);
  }
  CLI::App app;
  std::uint64_t seed = 0;
  std::string name;
  std::int64_t count = 0;
  std::optional<int> domain;
  int shift = 0;
};

TEST_CASE("a number that begins with zeros is a decimal") {
  Bench bench;
  bench.app.parse("--seed 08 --name 007 sub --domain 010 --shift -010");
  CHECK(bench.seed == 8);
  CHECK(bench.name == "007");
  CHECK(bench.domain == 10);
  CHECK(bench.shift == -10);
}

TEST_CASE("zeros alone are zero, and what is no number stays none") {
  Bench bench;
  bench.app.parse("--seed 000 sub --domain 0");
  CHECK(bench.seed == 0);
  CHECK(bench.domain == 0);
  bench.app.parse("--seed 0x10");
  CHECK(bench.seed == 16);
  for (const char* line : {"--seed 0.5", "--seed 08x", "--seed x", "sub --domain 0231"}) {
    CAPTURE(line);
    CHECK_THROWS_AS(bench.app.parse(line), CLI::ParseError);
  }
}

TEST_CASE("a number that 64 bits do not hold is refused, not made another one") {
  Bench bench;
  bench.app.parse("--seed 18446744073709551615");
  CHECK(bench.seed == 18446744073709551615U);
  const auto refusal = [&](const std::string& line) {
    try {
      bench.app.parse(line);
    } catch (const CLI::ParseError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  CHECK(refusal("--seed -1") == "--seed: '-1' is below 0");
  CHECK(refusal("--seed 18446744073709551616") ==
        "--seed: '18446744073709551616' is too large a number");
  CHECK(refusal("--count 9223372036854775808") ==
        "--count: '9223372036854775808' is too large a number");
  CHECK(refusal("--count -9223372036854775808") == "taken");
  CHECK(bench.count == std::numeric_limits<std::int64_t>::min());
}

}  // namespace
}  // namespace mpm::cli
