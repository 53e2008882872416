#include "idl/wait_set.hpp"

#include <catch2/catch.hpp>

#include "idl/reader.hpp"
#include "idl/writer.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {

TEST_CASE("a wait set has something from when a sample comes until it is taken") {
  using namespace std::chrono_literals;
  const DomainOptions options = test_domain("wait-set");
  const Participant reading(options), writing(options);
  Reader<mpm_Alarm> reader(reading, kAlarmTopic, alarm_qos());
  WaitSet wait_set;
  CHECK_FALSE(wait_set.wait(0s));  // nothing is attached
  wait_set.attach(reader.readable());
  CHECK_FALSE(wait_set.wait(0s));
  const Writer<mpm_Alarm> writer(writing, kAlarmTopic, alarm_qos());
  std::string unit = "unit", none;
  mpm_Alarm sample{};
  sample.unit = unit.data();
  sample.mv = sample.cv = sample.state = none.data();
  sample.cause = sample.cause_text = none.data();
  for (int k = 0; k < 3; ++k) {
    REQUIRE(writer.write(sample));
    CHECK(wait_set.wait(10s));
    CHECK(wait_set.wait(0s));
    CHECK(wait_set.ready());
    CHECK(reader.take([](const mpm_Alarm&) {}) == 1);
    CHECK_FALSE(wait_set.wait(0s));
  }
}

}  // namespace mpm::idl
