// mpm_soak: a monitor in a bad world, hundreds of times faster than a plant of a sample a second.
// What must hold is in docs/reliability.md; exit 1 where it does not.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "config/load_unit.hpp"
#include "idl/log.hpp"
#include "idl/unit_publisher.hpp"
#include "tests/soak/monitor.hpp"
#include "tests/soak/plant.hpp"
#include "tests/soak/score.hpp"
#include "tests/soak/viewers.hpp"

namespace mpm::soak {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kRight = 15'000, kWrong = 10'000;  // samples
constexpr double kGrace = 8000.0;                // s: twice the memory
constexpr std::size_t kViewers = 20;
constexpr double kBetweenEvents = 12.0;  // s, mean
constexpr double kBetweenMeasures = 1.0;
constexpr int kMeasuresInMean = 60;
constexpr int kGrown = 60'000;       // samples: what a process keeps of them it then has
constexpr double kQuietShare = 0.3;  // at the end nothing ends it: how one process fares for long
constexpr int kFloodRate = 20'000;
constexpr double kSecondsPerDay = 86'400.0;

struct Options {
  double minutes = 5.0;
  double rate = 1500.0;
  std::uint64_t seed = 100'001;
  std::string trace;
};

int free_port() {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof place;
  if (bind(probe, reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
      getsockname(probe, reinterpret_cast<sockaddr*>(&place), &size) != 0)
    throw std::runtime_error("no port is free");
  close(probe);
  return ntohs(place.sin_port);
}

/// The Shell unit, whose predictions the monitor makes itself.
std::string unit_text() {
  std::string text = test::read_file(MPM_SOURCE_DIR "/config/plants/shell3x3.yaml");
  text.replace(text.find("unit: shell"), 11, "unit: soak");
  for (const char* part :
       {"prediction: yhat1, setpoint: sp1, ", "prediction: yhat2, setpoint: sp2, ",
        "prediction: yhat3, setpoint: sp3, "})
    text.erase(text.find(part), std::string(part).size());
  return text;
}

UnitLayout layout_of(const config::UnitConfig& config, const std::string& unit) {
  UnitLayout layout;
  layout.unit = unit;
  for (const config::InputSignal& mv : config.mv) layout[SignalKind::kMv].tags.push_back(mv.tag);
  layout[SignalKind::kCv].tags = config.cv_tags();
  return layout;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Soak {
 public:
  explicit Soak(const Options& options)
      : options_(options),
        random_(options.seed),
        config_(config::load_unit_text(unit_text(), "soak.yaml").config),
        plant_(config_, options.seed, kRight, kWrong) {
    test::write_file(folder_.file("soak.yaml"), unit_text());
    fs::create_directory(folder_.file("state"));
    fs::create_directory(folder_.file("journal"));
    domain_.domain = 0;
    domain_.partition = "mpm-soak-" + std::to_string(getpid());
    domain_.multicast = false;
    port_ = free_port();
  }

  int run();

 private:
  enum class Event {
    kDisconnect,
    kControllerRestart,
    kBadSamples,
    kFullDisk,
    kFlood,
    kFreeze,
    kReload,
    kKill,
    kStop,
  };
  static constexpr const char* kNames[] = {
      "gateway gone and back",    "controller restarts",
      "bad samples for a while",  "disk full for five seconds",
      "flood of 20000 samples/s", "monitor frozen for two seconds",
      "reload (SIGHUP)",          "kill -9",
      "restart (SIGTERM)"};

  void publish(int samples);
  void happen(Event event);
  void bad_samples();
  void flood();
  void start_stopped_watcher();
  void measure();
  int report();

  [[nodiscard]] int below(int bound) {
    return static_cast<int>(random_() % static_cast<unsigned>(bound));
  }
  void connect() {
    publisher_.emplace(*participant_, layout_of(config_, "soak"), idl::WriterPace::kRealTime);
  }

  Options options_;
  std::mt19937_64 random_;
  config::UnitConfig config_;
  Plant plant_;
  test::TemporaryFolder folder_;
  idl::DomainOptions domain_;
  int port_ = 0;
  std::optional<idl::Participant> participant_;
  std::optional<idl::UnitPublisher> publisher_;
  std::unique_ptr<Monitor> monitor_;
  std::unique_ptr<Viewers> viewers_;
  std::optional<test::Process> watcher_;
  Clock::time_point start_, next_measure_;
  std::map<Event, int> events_;
  int ended_badly_ = 0;
  std::int64_t flooded_ = 0;
  std::ofstream trace_;
  Slope memory_{kMeasuresInMean}, disk_{kMeasuresInMean};
  double most_memory_ = 0.0, most_disk_ = 0.0, processor_s_ = 0.0, flood_rate_ = 0.0;
};

/// At the rate, whatever else has taken its time.
void Soak::publish(int samples) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < samples; ++i) {
    static_cast<void>(publisher_->publish(plant_.next()));
    const double ahead = (i + 1) / options_.rate - seconds_since(start);
    if (ahead > 0.005) std::this_thread::sleep_for(std::chrono::duration<double>(ahead));
  }
}

// Values that no process gives, values that are missing, samples twice and late.
void Soak::bad_samples() {
  const int samples = 50 + below(500), kind = below(6);
  std::vector<Frame> before;
  for (int i = 0; i < samples; ++i) {
    Frame frame = plant_.next();
    SignalBlock& block = frame[kind % 2 == 0 ? SignalKind::kCv : SignalKind::kMv];
    const auto which = static_cast<std::size_t>(below(3));
    double& value = block.values(static_cast<Eigen::Index>(which));
    switch (below(4) == 0 ? kind : -1) {
      case 0:
      case 1:
        value = std::numeric_limits<double>::quiet_NaN();
        break;
      case 2:
      case 3:
        block.quality[which] = Quality::kBad;
        break;
      case 4:
        value += 1e6;
        break;
      case 5:
        if (!before.empty()) static_cast<void>(publisher_->publish(before.back()));
        break;
      default:
        break;
    }
    static_cast<void>(publisher_->publish(frame));
    before = {frame};
    std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / options_.rate));
  }
}

// Of a unit that nobody watches, and of ours: intervals that were there already.
void Soak::flood() {
  const idl::UnitPublisher other(*participant_, layout_of(config_, "another"),
                                 idl::WriterPace::kRealTime);
  const Frame old = plant_.next();
  const Clock::time_point start = Clock::now();
  int sent = 0;
  constexpr int kPerFrame = 2;  // topics
  while (seconds_since(start) < 5.0) {
    for (int i = 0; i < 100; ++i)
      static_cast<void>((i % 2 == 0 ? other : *publisher_).publish(old));
    sent += 100 * kPerFrame;
    const double ahead = static_cast<double>(sent) / kFloodRate - seconds_since(start);
    if (ahead > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(ahead));
  }
  flooded_ += sent;
  flood_rate_ = std::max(flood_rate_, sent / seconds_since(start));
}

/// Reads the bus, and then does not.
void Soak::start_stopped_watcher() {
  watcher_.emplace(
      std::vector<std::string>{"mpm", "watch", "--json", "--domain", std::to_string(domain_.domain),
                               "--partition", domain_.partition},
      "/dev/null", "/dev/null");
}

void Soak::happen(Event event) {
  ++events_[event];
  switch (event) {
    case Event::kDisconnect:
      publisher_.reset();
      for (int gone = below(3000); gone > 0; --gone) static_cast<void>(plant_.next());
      connect();
      break;
    case Event::kControllerRestart:
      plant_.count_anew();
      break;
    case Event::kBadSamples:
      bad_samples();
      break;
    case Event::kFullDisk:
      monitor_->fill_disk(true);
      publish(static_cast<int>(5.0 * options_.rate));
      monitor_->fill_disk(false);
      break;
    case Event::kFlood:
      flood();
      break;
    case Event::kFreeze:
      monitor_->send(SIGSTOP);
      publish(static_cast<int>(2.0 * options_.rate));
      monitor_->send(SIGCONT);
      break;
    case Event::kReload:
      monitor_->send(SIGHUP);
      break;
    case Event::kKill:
      processor_s_ += monitor_->processor_s();
      static_cast<void>(monitor_->restart(SIGKILL));
      break;
    case Event::kStop:
      processor_s_ += monitor_->processor_s();
      ended_badly_ += monitor_->restart(SIGTERM) == 0 ? 0 : 1;
      break;
  }
}

void Soak::measure() {
  if (Clock::now() < next_measure_) return;
  next_measure_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(kBetweenMeasures));
  const double days =
      static_cast<double>(plant_.samples()) * config_.sample_time_s / kSecondsPerDay;
  const double memory = monitor_->resident_mb(), disk = monitor_->disk_mb();
  most_memory_ = std::max(most_memory_, memory);
  most_disk_ = std::max(most_disk_, disk);
  if (trace_.is_open())
    trace_ << seconds_since(start_) << ',' << days << ',' << monitor_->lives() << ',' << memory
           << ',' << disk << '\n';
  if (monitor_->age_s() * options_.rate > kGrown) memory_.add(monitor_->lives(), days, memory);
  if (seconds_since(start_) > 30.0 * options_.minutes) disk_.add(0, days, disk);
}

int Soak::run() {
  idl::set_log_handler({});
  participant_.emplace(domain_);
  connect();
  monitor_ = std::make_unique<Monitor>(folder_.file(""), domain_, port_, options_.seed);
  if (!publisher_->wait_for_readers(std::chrono::seconds(20)))
    throw std::runtime_error("no monitor: " + test::read_file(folder_.file("mpmd-0.log")));
  viewers_ = std::make_unique<Viewers>(port_, kViewers);
  start_ = Clock::now();
  if (!options_.trace.empty()) {
    trace_.open(options_.trace);
    trace_ << "seconds,days,process,memory_mb,disk_mb\n" << std::unitbuf;
  }
  const double end_s = 60.0 * options_.minutes;
  double next_event = kBetweenEvents;
  start_stopped_watcher();
  bool stopped = false;
  while (seconds_since(start_) < end_s) {
    publish(100);
    measure();
    const double now = seconds_since(start_);
    if (!stopped && now > 5.0) {
      watcher_->send(SIGSTOP);
      stopped = true;
    }
    if (!monitor_->runs()) throw std::runtime_error("mpmd has ended by itself");
    if (now < next_event) continue;
    next_event = now + std::exponential_distribution<double>(1.0 / kBetweenEvents)(random_);
    // Two in five are of those that end it.
    const int kind = below(now > (1.0 - kQuietShare) * end_s ? 6 : 9);
    happen(static_cast<Event>(kind));
  }
  // What is on its way to the journal of alarms comes there.
  processor_s_ += monitor_->processor_s();
  viewers_.reset();
  return report();
}

int Soak::report() {
  ended_badly_ += monitor_->restart(SIGTERM) == 0 ? 0 : 1;
  const AlarmScore alarms =
      score(monitor_->alarm_journal(), plant_.wrong_times(), 0.9 * kWrong, kGrace);
  const double wall_h = seconds_since(start_) / 3600.0;
  const double days =
      static_cast<double>(plant_.samples()) * config_.sample_time_s / kSecondsPerDay;
  const Slope::Estimate memory = memory_.estimate(), disk = disk_.estimate();
  const double log_kb = monitor_->log_kb();
  std::printf("samples                %lld: %.1f days of one a second, %.0f times real time\n",
              static_cast<long long>(plant_.samples()), days, 24.0 * days / wall_h);
  std::printf("took                   %.2f h, %.2f h of processor time of the monitor\n", wall_h,
              processor_s_ / 3600.0);
  for (const auto& [event, count] : events_)
    std::printf("%-30s %d\n", kNames[static_cast<int>(event)], count);
  std::printf("processes              %d; %d ended otherwise than asked\n", monitor_->lives(),
              ended_badly_);
  std::printf("memory                 %.1f MB at most; %+.3f +- %.3f MB/day (%zu points)\n",
              most_memory_, memory.slope, memory.error, memory.points);
  std::printf("disk                   %.1f MB at most; %+.3f +- %.3f MB/day (%zu points)\n",
              most_disk_, disk.slope, disk.error, disk.points);
  std::printf("journal of alarms      %.2f MB, %.3f MB/day (bounded at a million entries)\n",
              monitor_->alarm_journal_mb(), monitor_->alarm_journal_mb() / days);
  std::printf("log                    %.1f kB, %.2f kB/day of samples\n", log_kb, log_kb / days);
  std::printf(
      "alarms                 %d raised; of %d wrong times %d missed; %zu without a cause; "
      "%.0f s at most from a change to its alarm\n",
      alarms.raised, alarms.wrong_times, alarms.missed, alarms.wrong.size(),
      alarms.longest_delay_s);
  for (const std::string& line : alarms.wrong) std::printf("  without a cause: %s\n", line.c_str());
  std::printf("flood                  %lld samples, %.0f/s at most\n",
              static_cast<long long>(flooded_), flood_rate_);
  // For certain it grows by more than a twentieth in thirty days.
  const auto grows = [](const Slope::Estimate& estimate, double level) {
    return 30.0 * (estimate.slope - 3.0 * estimate.error) > 0.05 * level;
  };
  const bool good = alarms.missed == 0 && alarms.wrong.empty() && ended_badly_ == 0 &&
                    alarms.wrong_times > 0 && !grows(memory, most_memory_) &&
                    !grows(disk, most_disk_);
  std::printf("soak: %s\n", good ? "all right" : "NOT all right");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace mpm::soak

int main(int argc, char** argv) {
  CLI::App app("A monitor in a bad world, for as long as is wanted.", "mpm_soak");
  mpm::soak::Options options;
  app.add_option("--minutes", options.minutes, "how long, by the wall")->capture_default_str();
  app.add_option("--rate", options.rate, "samples a second, of a plant that has one a second")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of the plant and of what happens")->capture_default_str();
  app.add_option("--trace", options.trace, "memory and disk each second, as CSV into this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return mpm::soak::Soak(options).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mpm_soak: error: %s\n", error.what());
    return 2;
  }
}
