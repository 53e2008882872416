#include "idl/key_limit.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/text/printable.hpp"
#include "idl/raw_reader.hpp"
#include "idl/reader.hpp"
#include "idl/writer.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

using LayoutWriter = Writer<mpm_Layout>;

bool write(const LayoutWriter& writer, std::string unit, std::string kind = "mv") {
  mpm_Layout layout{};
  layout.unit = unit.data();
  layout.kind = kind.data();
  return writer.write(layout);
}

/// Units of which something was taken, until `last` was.
std::vector<std::string> units_until(RawReader& reader, const std::string& last) {
  std::vector<std::string> units;
  REQUIRE(eventually(
      [&] {
        reader.take([&](const RawSample& sample) {
          if (sample.valid) units.push_back(unit_of(sample.cdr));
        });
        return !units.empty() && units.back() == last;
      },
      std::chrono::seconds(30)));
  return units;
}

}  // namespace

TEST_CASE("of more instances than any plant has the keys are not kept, until their writer leaves") {
  const std::size_t most = KeyLimit::most(2);
  const DomainOptions domain = test_domain("key_limit");
  const Participant here(domain), there(domain);
  RawReader reader(here, *find_known_topic("mpm/layout"));
  const LayoutWriter known(there, "mpm/layout", layout_qos());
  REQUIRE(eventually([&] { return known.matched_readers() == 1; }));
  REQUIRE(write(known, "toy"));
  CHECK(units_until(reader, "toy").size() == 1);
  {
    const Participant elsewhere(domain);
    const LayoutWriter stranger(elsewhere, "mpm/layout", layout_qos());
    REQUIRE(eventually([&] { return stranger.matched_readers() == 1; }));
    std::size_t taken = 0;
    for (std::size_t i = 0; i < most + 1000; ++i) {
      REQUIRE(write(stranger, "stranger" + std::to_string(i)));
      if (i % 100 == 0)
        reader.take([&](const RawSample& sample) { taken += sample.valid ? 1 : 0; });
    }
    std::uint64_t refused = 0;
    REQUIRE(eventually([&] {
      reader.take([&](const RawSample& sample) { taken += sample.valid ? 1 : 0; });
      refused += reader.refused().samples;
      return taken + refused >= most + 1000;
    }));
    CHECK(taken == most - 1);  // with toy they are as many as may be
    CHECK(refused == 1001);
    REQUIRE(write(known, "new unit"));
    REQUIRE(write(known, "toy"));
    CHECK(units_until(reader, "toy") ==
          std::vector<std::string>{"toy"});  // known, and nothing else
    CHECK(reader.refused().unit == "new unit");
  }
  REQUIRE(eventually([&] { return reader.matched_writers() == 1; }));
  REQUIRE(eventually([&] {  // what the stranger had is free, once a sample has been taken
    REQUIRE(write(known, "toy"));
    REQUIRE(write(known, "new unit"));
    bool came = false;
    reader.take([&](const RawSample& sample) { came |= unit_of(sample.cdr) == "new unit"; });
    return came;
  }));
}

TEST_CASE("names longer than any unit file gives are not taken, of whichever key") {
  const DomainOptions domain = test_domain("key_length");
  const Participant here(domain), there(domain);
  RawReader raw(here, *find_known_topic("mpm/layout"));
  UnitChoice chosen({"toy"});
  Reader<mpm_Layout> reader(here, "mpm/layout", layout_qos(), 64, &chosen);
  const LayoutWriter writer(there, "mpm/layout", layout_qos());
  REQUIRE(eventually([&] { return writer.matched_readers() == 2; }));
  const std::string longest(kLongestName, 'n');
  REQUIRE(write(writer, longest + "n"));
  REQUIRE(write(writer, "toy", longest + "n"));
  std::string end = longest + "n";
  mpm_Layout ended{};
  ended.unit = end.data();
  REQUIRE(dds_dispose(writer.get(), &ended) == DDS_RETCODE_OK);
  REQUIRE(write(writer, "toy", longest));
  REQUIRE(write(writer, longest, longest));
  CHECK(units_until(raw, longest) == std::vector<std::string>{"toy", longest});
  CHECK(raw.refused().samples == 2);
  std::vector<std::string> kinds;
  REQUIRE(eventually([&] {
    reader.take([&](const mpm_Layout& layout) { kinds.emplace_back(layout.kind); });
    return !kinds.empty();
  }));
  CHECK(kinds == std::vector<std::string>{longest});
}

}  // namespace mpm::idl
