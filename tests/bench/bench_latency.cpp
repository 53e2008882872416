// Round trips between processes on loopback, in turns: bare UDP, DDS, and a unit's frame through
// mpmd until the status of all its channels is back. Prints "name median_us p99_us count".
//
//   bench_latency MPMD UNIT_FILE
#include <arpa/inet.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "config/load_unit.hpp"
#include "config/unit_layout.hpp"
#include "core/signal/aligner.hpp"
#include "idl/reader.hpp"
#include "idl/unit_publisher.hpp"
#include "idl/wait_set.hpp"
#include "idl/writer.hpp"
#include "sim/loop/closed_loop.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kDomain = 7;
constexpr unsigned kLongestRun_s = 100;
constexpr std::chrono::seconds kPatience{5};
constexpr int kRounds = 5;
constexpr std::chrono::milliseconds kPause{4};  // between paced round trips

constexpr const char* kPingTopic = "bench/ping";
constexpr const char* kPongTopic = "bench/pong";

idl::DomainOptions domain_of(const std::string& partition) {
  idl::DomainOptions options;
  options.domain = kDomain;
  options.partition = partition;
  return options;
}

/// A process that dies with this one.
class Child {
 public:
  /// Runs `body` in a fork; to be called before any thread exists.
  explicit Child(const std::function<void()>& body) : pid_(fork()) {
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    try {
      body();
    } catch (const std::exception& error) {
      std::cerr << "bench_latency: child: " << error.what() << '\n';
    }
    _exit(1);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }

 private:
  pid_t pid_;
};

/// Bare UDP on loopback; both ends exist before the fork.
class UdpPair {
 public:
  UdpPair() : here_(make()), there_(make()) {
    join(here_, there_);
    join(there_, here_);
  }
  void echo() const {
    Packet packet{};
    for (;;) {
      const ssize_t length = recv(there_, packet.data(), packet.size(), 0);
      if (length > 0 && send(there_, packet.data(), static_cast<std::size_t>(length), 0) < 0)
        return;
    }
  }
  void round_trip() const {
    Packet packet{};
    if (send(here_, packet.data(), packet.size(), 0) < 0 ||
        recv(here_, packet.data(), packet.size(), 0) < 0)
      throw std::runtime_error("UDP lost a packet");
  }

 private:
  using Packet = std::array<char, 200>;

  static int make() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (socket < 0 || bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot bind a UDP socket");
    return socket;
  }
  static void join(int from, int to) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (getsockname(to, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        connect(from, reinterpret_cast<sockaddr*>(&address), size) != 0)
      throw std::runtime_error("cannot connect a UDP socket");
  }

  int here_, there_;
};

/// One end of a DDS ping-pong.
class DdsEnd {
 public:
  DdsEnd(const std::string& partition, const char* out, const char* in)
      : participant_(domain_of(partition)),
        writer_(participant_, out, idl::sample_writer_qos(idl::WriterPace::kRealTime)),
        reader_(participant_, in, idl::sample_reader_qos()) {
    wait_set_.attach(reader_.readable());
    sample_.unit = unit_.data();
    sample_.values = {static_cast<std::uint32_t>(values_.size()),
                      static_cast<std::uint32_t>(values_.size()), values_.data(), false};
  }
  void wait_for_peer() const {
    const Clock::time_point deadline = Clock::now() + kPatience;
    while (writer_.matched_readers() == 0 || reader_.matched_writers() == 0) {
      if (Clock::now() > deadline) throw std::runtime_error("no DDS peer");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void send() {
    if (!writer_.write(sample_)) throw std::runtime_error("DDS did not write");
  }
  void receive() {
    int count = 0;
    while (count == 0) {
      if (!wait_set_.wait(kPatience)) throw std::runtime_error("DDS lost a sample");
      count = reader_.take([](const mpm_Sample&) {});
    }
  }
  void echo() {
    for (;;)
      if (wait_set_.wait(kPatience) && reader_.take([](const mpm_Sample&) {}) > 0) send();
  }

 private:
  idl::Participant participant_;
  idl::Writer<mpm_Sample> writer_;
  idl::Reader<mpm_Sample> reader_;
  idl::WaitSet wait_set_;
  std::string unit_ = "bench";
  std::array<double, 18> values_{};  // about 200 bytes in all
  mpm_Sample sample_{};
};

/// The control system's side of a unit under mpmd.
class MonitoredUnit {
 public:
  MonitoredUnit(const sim::LoopSetup& setup, const std::string& partition)
      : loop_(setup),
        channels_(setup.unit.counts().inputs() * setup.unit.counts().cv),
        participant_(domain_of(partition)),
        publisher_(participant_, config::unit_layout(setup.unit), idl::WriterPace::kRealTime),
        reader_(participant_, idl::kChannelStatusTopic, idl::channel_status_reader_qos()) {
    wait_set_.attach(reader_.readable());
    if (!publisher_.wait_for_readers(kPatience)) throw std::runtime_error("mpmd does not read");
    const Clock::time_point deadline = Clock::now() + kPatience;
    while (reader_.matched_writers() == 0) {
      if (Clock::now() > deadline) throw std::runtime_error("mpmd does not write");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// The first frame after a start waits until its stragglers would be late: begins with a few
  /// frames at once, then goes on until the channels are judged.
  void warm_up() {
    for (int i = 0; i <= AlignerSettings{}.max_lateness; ++i) {
      advance();
      publish();
    }
    do {
      advance();
      round_trip();
    } while (!judged_);
  }
  /// Not part of what is timed.
  void advance() { frame_ = loop_.step(); }
  void round_trip() {
    publish();
    int left = channels_;
    judged_ = true;
    while (left > 0) {
      if (!wait_set_.wait(kPatience)) throw std::runtime_error("mpmd does not answer");
      reader_.take([&](const mpm_ChannelStatus& status) {
        if (status.interval != frame_.interval) return;
        --left;
        judged_ = judged_ && std::string_view(status.reason) != "warming_up";
      });
    }
  }

 private:
  void publish() const {
    if (!publisher_.publish(frame_)) throw std::runtime_error("cannot publish a frame");
  }

  sim::ClosedLoop loop_;
  int channels_;
  idl::Participant participant_;
  idl::UnitPublisher publisher_;
  idl::Reader<mpm_ChannelStatus> reader_;
  idl::WaitSet wait_set_;
  Frame frame_;
  bool judged_ = false;
};

struct Trip {
  std::string name;
  int count;  // per round
  std::function<void()> prepare;
  std::function<void()> run;
  bool paced;
  std::vector<double> times_us{};
};

void measure(Trip& trip) {
  for (int i = 0; i < trip.count; ++i) {
    if (trip.prepare) trip.prepare();
    if (trip.paced) std::this_thread::sleep_for(kPause);
    const Clock::time_point begin = Clock::now();
    trip.run();
    trip.times_us.push_back(
        std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  }
}

void print(Trip& trip) {
  std::sort(trip.times_us.begin(), trip.times_us.end());
  const std::size_t count = trip.times_us.size();
  std::cout << trip.name << ' ' << trip.times_us[count / 2] << ' '
            << trip.times_us[count * 99 / 100] << ' ' << count << std::endl;
}

void run(const std::string& mpmd, const std::string& unit_file) {
  alarm(kLongestRun_s);
  sim::LoopSetup setup;
  config::LoadResult loaded = config::load_unit(unit_file);
  if (!loaded.ok()) throw std::runtime_error("cannot read " + unit_file);
  setup.unit = std::move(loaded.config);
  setup.controller_model = setup.unit.model;

  const std::string partition = "bench-" + std::to_string(getpid());
  const UdpPair udp;
  const Child udp_echo([&] { udp.echo(); });
  const Child dds_echo([&] { DdsEnd(partition, kPongTopic, kPingTopic).echo(); });
  const Child daemon([&] {
    execl(mpmd.c_str(), mpmd.c_str(), "--config", unit_file.c_str(), "--domain",
          std::to_string(kDomain).c_str(), "--partition", partition.c_str(), "--log-level", "error",
          nullptr);
  });

  DdsEnd dds(partition, kPingTopic, kPongTopic);
  dds.wait_for_peer();
  MonitoredUnit unit(setup, partition);
  unit.warm_up();

  const auto over_udp = [&] { udp.round_trip(); };
  const auto over_dds = [&] {
    dds.send();
    dds.receive();
  };
  const auto advance = [&] { unit.advance(); };
  const auto over_mpmd = [&] { unit.round_trip(); };
  std::array<Trip, 6> trips{{{"udp", 2000, {}, over_udp, false},
                             {"dds", 1000, {}, over_dds, false},
                             {"mpmd", 1000, advance, over_mpmd, false},
                             {"udp_paced", 250, {}, over_udp, true},
                             {"dds_paced", 250, {}, over_dds, true},
                             {"mpmd_paced", 250, advance, over_mpmd, true}}};
  for (int round = 0; round < kRounds; ++round)
    for (Trip& trip : trips) measure(trip);
  for (Trip& trip : trips) print(trip);
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_latency MPMD UNIT_FILE\n";
    return 3;
  }
  try {
    mpm::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "bench_latency: " << error.what() << '\n';
    return 2;
  }
}
