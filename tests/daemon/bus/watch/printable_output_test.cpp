#include "daemon/bus/watch/printable_output.hpp"

#include <catch2/catch.hpp>

#include "daemon/bus/watch/render.hpp"

using namespace mpm;

TEST_CASE("no text from the bus commands the terminal that watches") {
  const std::string evil = "u\x1b[2J\nforged";
  const std::string shown = "u\\x1b[2J\\nforged";
  ChannelRecord channel;
  channel.unit = channel.mv = channel.cv = evil;
  channel.reason = Reason::kCollinear;
  channel.confounder = evil;
  const auto clean = std::get<ChannelRecord>(bus::printable_output(channel));
  CHECK((clean.unit == shown && clean.mv == shown && clean.cv == shown));
  CHECK(clean.confounder == shown);
  CHECK(bus::change_line(nullptr, clean).find_first_of("\x1b\n") == std::string::npos);

  AlarmRecord alarm;
  alarm.unit = alarm.mv = alarm.cv = evil;
  alarm.to = AlarmChange::kDiagnosed;
  alarm.named = {evil, evil + std::string(10'000'000, 'x'), 0.9, {{evil, 1.0, 0.9, 1.1}}};
  const auto named = std::get<AlarmRecord>(bus::printable_output(alarm)).named;
  CHECK(named.cause == shown);
  CHECK(named.text.rfind(shown, 0) == 0);
  CHECK(named.text.size() < 2000);
  CHECK(named.parameters.at(0).name == shown);

  HealthRecord health;
  health.unit = health.state = health.detail = evil;
  const auto healthy = std::get<HealthRecord>(bus::printable_output(health));
  CHECK((healthy.unit == shown && healthy.state == shown && healthy.detail == shown));
  const auto layout = std::get<idl::LayoutRecord>(
      bus::printable_output(idl::LayoutRecord{evil, evil, {evil, "u1"}}));
  CHECK((layout.unit == shown && layout.kind == shown));
  CHECK(layout.tags == std::vector<std::string>{shown, "u1"});
  CHECK(std::get<idl::MonitorGone>(bus::printable_output(idl::MonitorGone{evil})).unit == shown);
}
