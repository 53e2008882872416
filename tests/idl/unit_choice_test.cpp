#include "idl/unit_choice.hpp"

#include <catch2/catch.hpp>

#include "idl/reader.hpp"
#include "idl/writer.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

mpm_Sample sample_of(std::string& unit) {
  mpm_Sample sample{};
  sample.unit = unit.data();
  return sample;
}

}  // namespace

TEST_CASE("names of units that nobody watches fill no memory, and are counted") {
  constexpr int kNames = 20'000;
  const DomainOptions domain = test_domain("unit_choice");
  const Participant here(domain), there(domain);
  UnitChoice chosen({"toy"});
  Reader<mpm_Sample> reader(here, "mpm/mv", sample_reader_qos(), 64, &chosen);
  const Writer<mpm_Sample> writer(there, "mpm/mv", sample_writer_qos(WriterPace::kLossless));
  REQUIRE(eventually([&] { return writer.matched_readers() == 1; }));

  std::string unit;
  for (int i = 0; i < kNames; ++i) {
    unit = "stranger" + std::to_string(i);
    REQUIRE(writer.write(sample_of(unit)));
  }
  unit = "toy";
  REQUIRE(writer.write(sample_of(unit)));
  int taken = 0;
  std::uint64_t handle = 0;
  REQUIRE(eventually([&] {
    reader.take_with_info([&](const mpm_Sample& sample, const SampleInfo& info) {
      taken += std::string(sample.unit) == "toy";
      handle = info.writer;
    });
    return taken > 0;
  }));

  // What this side of the bus keeps of a name has a handle.
  const auto kept = [&](std::string name) {
    const mpm_Sample key = sample_of(name);
    return dds_lookup_instance(reader.get(), &key) != DDS_HANDLE_NIL;
  };
  CHECK(kept("toy"));
  int strangers = 0;
  for (int i = 0; i < kNames; ++i) strangers += kept("stranger" + std::to_string(i)) ? 1 : 0;
  CHECK(strangers < 10);

  const UnitChoice::Refused refused = chosen.refused();
  CHECK(refused.samples == kNames);
  CHECK(refused.units.size() == 8);
  REQUIRE(refused.units.count("stranger0") == 1);
  CHECK(refused.units.at("stranger0") == handle);
  CHECK(chosen.refused().samples == 0);
}

}  // namespace mpm::idl
