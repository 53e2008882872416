#include "tests/system/bench.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test {

std::string unit_yaml(const std::string& unit) {
  const std::string shipped = read_file(MPM_SOURCE_DIR "/tests/hmi/toy.yaml");
  const std::size_t name = shipped.find("toy");
  return shipped.substr(0, name) + unit + shipped.substr(name + 3);
}

const Frame& Plant::next() {
  const double pole = std::exp(-1.0 / 5.0);  // time constant 5 s, sampled each second
  const double gains[2] = {first_gain_, 1.0};
  std::normal_distribution<double> noise(0.0, 0.05);
  SignalBlock& mv = frame_[SignalKind::kMv];
  SignalBlock& cv = frame_[SignalKind::kCv];
  ++frame_.interval;
  frame_.source_time_ns = frame_.interval * 1'000'000'000;
  cv.values(0) = states_[0] + states_[1] + noise(random_);
  cv.quality[0] = Quality::kGood;
  for (int i = 0; i < 2; ++i) {
    states_[i] = pole * states_[i] + gains[i] * (1.0 - pole) * moves_[i];  // one sample dead time
    if (random_() % 10 == 0) moves_[i] = random_() % 2 == 0 ? 1.0 : -1.0;
    mv.values(i) = moves_[i];
    mv.quality[static_cast<std::size_t>(i)] = Quality::kGood;
  }
  return frame_;
}

Bench::Bench(const std::string& test, const std::vector<std::string>& more,
             const std::vector<std::string>& environment)
    : options(idl::test_domain(test)),
      daemon(daemon_arguments(more), folder.file("mpmd.out"), folder.file("mpmd.err"), environment),
      participant(options),
      readers(participant) {
  INFO(read_file(folder.file("mpmd.err")));
  REQUIRE(observe([&] { return !health().unit.empty(); }));  // it is there
}

std::vector<std::string> Bench::daemon_arguments(const std::vector<std::string>& more) {
  write_file(folder.file("toy.yaml"), unit_yaml("toy"));
  std::vector<std::string> arguments = {"mpmd",
                                        "--config",
                                        folder.file("toy.yaml"),
                                        "--domain",
                                        std::to_string(options.domain),
                                        "--partition",
                                        options.partition};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

idl::UnitPublisher Bench::publisher(idl::WriterPace pace, const std::string& unit) {
  UnitLayout layout;
  layout.unit = unit;
  layout[SignalKind::kMv].tags = {"u1", "u2"};
  layout[SignalKind::kCv].tags = {"y1"};
  return {participant, layout, pace};
}

void Bench::publish(const idl::UnitPublisher& publisher, Plant& plant, int frames) {
  REQUIRE(publisher.wait_for_readers(std::chrono::seconds(20)));
  for (int i = 0; i < frames; ++i) REQUIRE(publisher.publish(plant.next()));
}

HealthRecord Bench::health(const std::string& unit) const {
  HealthRecord last;
  for (const auto& record : seen<HealthRecord>())
    if (record.unit == unit) last = record;
  return last;
}

std::vector<std::string> Bench::watch(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments = {
      "mpm", "watch", "--domain", std::to_string(options.domain), "--partition", options.partition};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace mpm::test
