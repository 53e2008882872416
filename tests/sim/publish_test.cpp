#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "idl/sample_readers.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/sim/units.hpp"

namespace {

using mpm::Frame;
using mpm::SignalKind;
using Clock = std::chrono::steady_clock;

/// mpmsim on Shell as a process of its own.
class Simulator {
 public:
  Simulator(const mpm::idl::DomainOptions& domain, std::vector<std::string> arguments)
      : arguments_(std::move(arguments)) {
    arguments_.insert(arguments_.begin(),
                      {std::string(MPM_BIN_DIR) + "/mpmsim", "--config",
                       std::string(MPM_SOURCE_DIR) + "/config/plants/shell3x3.yaml", "--domain",
                       std::to_string(domain.domain), "--partition", domain.partition});
    std::vector<char*> pointers;
    for (std::string& argument : arguments_) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      execv(pointers[0], pointers.data());
      _exit(127);
    }
  }
  ~Simulator() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  void stop() const { kill(child_, SIGTERM); }
  /// Exit code, or -1 if it has not ended by itself within 10 s.
  [[nodiscard]] int wait() {
    const Clock::time_point end = Clock::now() + std::chrono::seconds(10);
    int status = 0;
    while (waitpid(child_, &status, WNOHANG) == 0) {
      if (Clock::now() > end) return -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::vector<std::string> arguments_;
  pid_t child_ = 0;
};

}  // namespace

TEST_CASE("what mpmsim publishes at full speed is the run of its seed, nothing missing") {
  constexpr int kSamples = 2000;
  const mpm::idl::DomainOptions domain = mpm::idl::test_domain("sim-full-speed");
  const mpm::idl::Participant participant(domain);
  mpm::idl::SampleReaders readers(participant);
  mpm::idl::WaitSet wait_set;
  readers.attach_to(wait_set);
  Simulator simulator(domain, {"--samples", std::to_string(kSamples), "--seed", "3", "--speed", "0",
                               "--wait-readers", "10", "--start-time", "2024-03-01T12:00:00Z"});

  std::vector<Frame> expected;
  mpm::sim::LoopSetup setup = mpm::test::healthy_loop(mpm::test::load_plant("shell3x3"), 3);
  setup.start_time_ns = 1'709'294'400'000'000'000;
  mpm::sim::ClosedLoop loop(setup);
  expected.reserve(kSamples);
  for (int k = 0; k < kSamples; ++k) expected.push_back(loop.step());

  int count = 0, wrong = 0;
  std::array<std::int64_t, mpm::kSignalKindCount> next{};
  constexpr int kTopics = 4;  // mv, cv, prediction, set-point; this unit has no DV
  while (count < kTopics * kSamples && wait_set.wait(std::chrono::seconds(10)))
    readers.take([&](const mpm::idl::SampleView& sample) {
      ++count;
      std::int64_t& interval = next[static_cast<std::size_t>(sample.kind)];
      if (sample.interval != interval++ || sample.interval >= kSamples) {
        ++wrong;
        return;
      }
      const Frame& frame = expected[static_cast<std::size_t>(sample.interval)];
      const auto& values = frame[sample.kind].values;
      const bool same =
          sample.unit == "shell" && sample.source_time_ns == frame.source_time_ns &&
          std::equal(sample.values.begin(), sample.values.end(), values.begin(), values.end());
      if (!same) ++wrong;
    });
  CHECK(count == kTopics * kSamples);
  CHECK(wrong == 0);
  CHECK(simulator.wait() == 0);
}

TEST_CASE("bad data reach DDS as gaps, qualities and times") {
  constexpr int kSamples = 1000;
  const mpm::idl::DomainOptions domain = mpm::idl::test_domain("sim-bad-data");
  const mpm::idl::Participant participant(domain);
  mpm::idl::SampleReaders readers(participant);
  mpm::idl::WaitSet wait_set;
  readers.attach_to(wait_set);
  Simulator simulator(
      domain, {"--samples", std::to_string(kSamples), "--speed", "0", "--wait-readers", "10",
               "--start-time", "1000", "--bad-data", "gaps=10%", "--bad-data",
               "missing=20%,tags=y2", "--bad-data", "time_jitter=20%"});
  // One run of 10 in every 100 intervals is absent.
  constexpr int kRows = 900, kTopics = 4;
  int count = 0, missing = 0, wrong = 0;
  while (count < kTopics * kRows && wait_set.wait(std::chrono::seconds(10)))
    readers.take([&](const mpm::idl::SampleView& sample) {
      ++count;
      const std::int64_t exact = (1000 + sample.interval) * 1'000'000'000;
      if (std::abs(sample.source_time_ns - exact) > 200'001'000) ++wrong;
      if (sample.kind != SignalKind::kCv) return;
      const auto quality = [&](std::size_t cv) {
        return sample.quality.empty() ? mpm::Quality::kGood
                                      : static_cast<mpm::Quality>(sample.quality[cv]);
      };
      if (quality(1) == mpm::Quality::kBad) ++missing;
      if (quality(0) != mpm::Quality::kGood) ++wrong;
    });
  CHECK(count == kTopics * kRows);
  CHECK(wrong == 0);
  CHECK(std::abs(missing - kRows / 5) < 60);  // binomial, sd 12
  CHECK(simulator.wait() == 0);
}

TEST_CASE("mpmsim sends each sample when it is due, and SIGTERM ends its waiting") {
  const mpm::idl::DomainOptions domain = mpm::idl::test_domain("sim-pace");
  const mpm::idl::Participant participant(domain);
  mpm::idl::SampleReaders readers(participant);
  mpm::idl::WaitSet wait_set;
  readers.attach_to(wait_set);
  // A sample is 1 s long in this unit: the next one 20 ms later, or an hour.
  const auto [speed, until] =
      GENERATE(std::pair<const char*, int>("50", 50), std::pair<const char*, int>("0.00028", 0));
  Simulator simulator(domain, {"--speed", speed, "--wait-readers", "10"});
  std::int64_t last = -1;
  const auto take = [&] {
    readers.take([&](const mpm::idl::SampleView& sample) { last = sample.interval; });
  };
  while (last < until && wait_set.wait(std::chrono::seconds(10))) take();
  CHECK(last >= until);
  simulator.stop();
  CHECK(simulator.wait() == 0);
  take();
  if (until == 0) CHECK(last == 0);  // the second was not due
}
