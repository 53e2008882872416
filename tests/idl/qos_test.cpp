#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <map>

#include "idl/log.hpp"
#include "idl/sample_readers.hpp"
#include "idl/unit_publisher.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

char* text(const char* literal) { return const_cast<char*>(literal); }

mpm_Alarm alarm(const char* mv, std::int64_t interval, const char* state) {
  mpm_Alarm sample{};
  sample.unit = text("unit");
  sample.mv = text(mv);
  sample.cv = text("y1");
  sample.state = text(state);
  sample.interval = interval;
  return sample;
}

}  // namespace

TEST_CASE("who joins late gets the current alarm of each channel, once, and nothing older") {
  const DomainOptions options = test_domain("late");
  const Participant daemon(options);
  const Writer<mpm_Alarm> writer(daemon, kAlarmTopic, alarm_qos());
  for (std::int64_t k = 0; k < 100; ++k)
    for (const char* mv : {"u1", "u2", "u3"})
      REQUIRE(writer.write(alarm(mv, k, k % 2 == 0 ? "active" : "cleared")));
  REQUIRE(writer.write(alarm("u2", 100, "active")));

  const Participant late(options);
  Reader<mpm_Alarm> reader(late, kAlarmTopic, alarm_qos());
  std::map<std::string, std::string> states;
  int count = 0;
  CHECK(eventually([&] {
    reader.take([&](const mpm_Alarm& sample) {
      states[sample.mv] = sample.state;
      ++count;
    });
    return states.size() == 3;
  }));
  // A writer's samples come in their order: what else is on its way comes before this one.
  REQUIRE(writer.write(alarm("u4", 101, "active")));
  CHECK(eventually([&] {
    reader.take([&](const mpm_Alarm& sample) {
      states[sample.mv] = sample.state;
      ++count;
    });
    return states.count("u4") == 1;
  }));
  CHECK(count == 4);
  CHECK(states == std::map<std::string, std::string>{
                      {"u1", "cleared"}, {"u2", "active"}, {"u3", "cleared"}, {"u4", "active"}});
}

TEST_CASE("who joins late gets the last changes of alarms in their order") {
  const DomainOptions options = test_domain("events");
  const Participant daemon(options);
  const Writer<mpm_AlarmEvent> writer(daemon, kAlarmEventTopic, alarm_event_writer_qos());
  for (std::int64_t k = 0; k < 200; ++k) {
    mpm_AlarmEvent event{};
    event.unit = text("unit");
    event.mv = text("u1");
    event.cv = text("y1");
    event.to = text("active");
    event.interval = k;
    REQUIRE(writer.write(event));
  }
  const Participant late(options);
  Reader<mpm_AlarmEvent> reader(late, kAlarmEventTopic, alarm_event_reader_qos());
  std::vector<std::int64_t> seen;
  CHECK(eventually([&] {
    reader.take([&](const mpm_AlarmEvent& event) { seen.push_back(event.interval); });
    return !seen.empty() && seen.back() == 199;
  }));
  CHECK(seen.size() == 64);
  CHECK(std::is_sorted(seen.begin(), seen.end()));
}

TEST_CASE("a daemon that ends leaves its last word, marked as nobody's") {
  const DomainOptions options = test_domain("gone");
  const Participant viewer(options);
  Reader<mpm_Health> reader(viewer, kHealthTopic, health_qos());
  bool heard = false, alone = false;
  const auto look = [&] {
    reader.take_with_info([&](const mpm_Health& health, const SampleInfo& info) {
      CHECK(std::string(health.unit) == "unit");
      if (info.valid) heard = true;
      if (info.state == InstanceState::kNoWriters) alone = true;
      CHECK(info.state != InstanceState::kDisposed);
    });
  };
  {
    const Participant daemon(options);
    const Writer<mpm_Health> writer(daemon, kHealthTopic, health_qos());
    mpm_Health health{};
    health.unit = text("unit");
    health.state = text("normal");
    health.detail = text("");
    REQUIRE(writer.write(health));
    CHECK(eventually([&] {
      look();
      return heard;
    }));
    CHECK_FALSE(alone);
  }
  CHECK(eventually([&] {
    look();
    return alone;
  }));
}

TEST_CASE(
    "frames arrive as they were published, with their layout, and the first one is not lost") {
  // The window in which a first sample can get lost is short: try often.
  for (int round = 0; round < 10; ++round) {
    const DomainOptions options = test_domain("frames" + std::to_string(round));
    const Participant reading(options), writing(options);
    SampleReaders readers(reading);
    Reader<mpm_Layout> layouts(reading, kLayoutTopic, layout_qos());
    UnitLayout layout;
    layout.unit = "unit";
    layout.sample_time_s = 2.5;
    layout[SignalKind::kMv] = {{"u1", "u2"}, {"%", "t/h"}};
    layout[SignalKind::kCv].tags = {"y1"};
    layout[SignalKind::kPrediction].tags = {"yhat1"};
    const UnitPublisher publisher(writing, layout, WriterPace::kRealTime);
    REQUIRE(publisher.wait_for_readers(std::chrono::seconds(10)));

    Frame frame(SignalCounts{2, 0, 1, 0});
    frame.interval = 7;
    frame.source_time_ns = 123'456'789'012'345;
    frame[SignalKind::kMv].values << 1.5, -0.0;
    frame[SignalKind::kMv].quality = {Quality::kGood, Quality::kUncertain};
    frame[SignalKind::kCv].values << 42.0;
    frame[SignalKind::kCv].quality = {Quality::kBad};
    REQUIRE(publisher.publish(frame));

    std::map<SignalKind, std::vector<double>> values;
    std::map<SignalKind, std::vector<std::uint8_t>> quality;
    CHECK(eventually([&] {
      readers.take([&](const SampleView& sample) {
        CHECK(sample.unit == "unit");
        CHECK(sample.interval == 7);
        CHECK(sample.source_time_ns == 123'456'789'012'345);
        values[sample.kind].assign(sample.values.begin(), sample.values.end());
        quality[sample.kind].assign(sample.quality.begin(), sample.quality.end());
      });
      return values.size() == 3;
    }));
    CHECK(values[SignalKind::kMv] == std::vector<double>{1.5, -0.0});
    CHECK(quality[SignalKind::kMv] == std::vector<std::uint8_t>{0, 1});
    CHECK(values[SignalKind::kCv] == std::vector<double>{42.0});
    CHECK(quality[SignalKind::kCv] == std::vector<std::uint8_t>{2});
    CHECK(values.count(SignalKind::kPrediction) == 1);
    CHECK(values.count(SignalKind::kSetpoint) == 0);

    std::map<std::string, std::vector<std::string>> units_of;
    CHECK(eventually([&] {
      layouts.take([&](const mpm_Layout& sample) {
        CHECK(sample.sample_time_s == 2.5);
        REQUIRE(sample.tags._length == sample.engineering_units._length);
        for (std::uint32_t i = 0; i < sample.tags._length; ++i)
          units_of[sample.kind].push_back(std::string(sample.tags._buffer[i]) + "/" +
                                          sample.engineering_units._buffer[i]);
      });
      return units_of.size() == 3;
    }));
    CHECK(units_of["mv"] == std::vector<std::string>{"u1/%", "u2/t/h"});
    CHECK(units_of["prediction"] == std::vector<std::string>{"yhat1/"});
  }
}

TEST_CASE("a stranger learns every type from the network") {
  const DomainOptions options = test_domain("types");
  const Participant daemon(options), stranger(options);
  const Writer<mpm_Sample> sample(daemon, "mpm/mv", sample_writer_qos(WriterPace::kRealTime));
  const Writer<mpm_Layout> layout(daemon, kLayoutTopic, layout_qos());
  const Writer<mpm_ChannelStatus> status(daemon, kChannelStatusTopic, channel_status_writer_qos());
  const Writer<mpm_Alarm> alarms(daemon, kAlarmTopic, alarm_qos());
  const Writer<mpm_AlarmEvent> events(daemon, kAlarmEventTopic, alarm_event_writer_qos());
  const Writer<mpm_Health> health(daemon, kHealthTopic, health_qos());
  const Writer<mpm_Performance> performance(daemon, kPerformanceTopic, performance_qos());

  const Entity publications(
      dds_create_reader(stranger.get(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
      "publications");
  std::map<std::string, dds_return_t> result;
  CHECK(eventually([&] {
    void* samples[16] = {};
    dds_sample_info_t infos[16];
    const int count = dds_take(publications.get(), samples, infos, 16, 16);
    for (int i = 0; i < count; ++i) {
      auto* endpoint = static_cast<dds_builtintopic_endpoint_t*>(samples[i]);
      const dds_typeinfo_t* info = nullptr;
      dds_topic_descriptor_t* descriptor = nullptr;
      if (!infos[i].valid_data || dds_builtintopic_get_endpoint_type_info(endpoint, &info) != 0)
        continue;
      const dds_return_t code = dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, stranger.get(),
                                                            info, DDS_SECS(5), &descriptor);
      result[endpoint->topic_name] = code;
      if (code == DDS_RETCODE_OK) dds_delete_topic_descriptor(descriptor);
    }
    if (count > 0) dds_return_loan(publications.get(), samples, count);
    return result.size() == 7;
  }));
  for (const auto& [topic, code] : result) {
    INFO(topic);
    CHECK(code == DDS_RETCODE_OK);
  }
}

TEST_CASE("a refused setting says why") {
  set_log_handler({});
  DomainOptions options = test_domain("refused");
  options.interface = "nosuchnic0";
  CHECK_THROWS_WITH(Participant(options), Catch::Contains("nosuchnic0"));
}

TEST_CASE("partition names cannot break out of the configuration") {
  DomainOptions options = test_domain("escape");
  options.partition = "a<b>&\"c";
  CHECK(domain_xml(options).find("<Tag>a&lt;b&gt;&amp;&quot;c</Tag>") != std::string::npos);
  CHECK_NOTHROW(Participant(options));
}

}  // namespace mpm::idl
