#include "sim/publish.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <limits>

#include "config/unit_layout.hpp"
#include "idl/participant.hpp"
#include "idl/unit_publisher.hpp"

namespace mpm::sim {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration_cast;

constexpr std::chrono::seconds kFlushTime{10};

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

/// Sleeps until `deadline`; true if told to stop before.
bool stopped_before(Clock::time_point deadline) {
  const sigset_t signals = stop_signals();
  while (true) {
    const auto left = std::max(duration_cast<std::chrono::nanoseconds>(deadline - Clock::now()),
                               std::chrono::nanoseconds::zero());
    const auto seconds = duration_cast<std::chrono::seconds>(left);
    timespec timeout{};
    timeout.tv_sec = static_cast<time_t>(seconds.count());
    timeout.tv_nsec = static_cast<long>((left - seconds).count());
    if (sigtimedwait(&signals, nullptr, &timeout) > 0) return true;
    if (Clock::now() >= deadline) return false;
  }
}

idl::DomainOptions domain_options(const config::DdsSettings& settings, const Options& options) {
  idl::DomainOptions domain;
  domain.domain = options.domain.value_or(settings.domain);
  domain.interface = settings.interface;
  domain.peers = settings.peers;
  domain.multicast = settings.multicast;
  domain.partition = options.partition.value_or(settings.partition);
  domain.max_participants = settings.max_participants;
  domain.security = options.security.value_or(settings.security);
  domain.role = "gateway";
  return domain;
}

/// False if told to stop.
bool wait_for_readers(const idl::UnitPublisher& publisher, double seconds, int readers) {
  const auto end =
      Clock::now() + duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (Clock::now() < end) {
    if (publisher.wait_for_readers(std::chrono::milliseconds(200), readers)) return true;
    if (stopped_before(Clock::now())) return false;
  }
  if (seconds > 0.0)
    spdlog::warn("not every topic has {} after {} s",
                 readers == 1 ? "a reader" : fmt::format("{} readers", readers), seconds);
  return true;
}

}  // namespace

void block_stop_signals() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

int run_dds(const LoopSetup& setup, const Options& options, BadDataFilter& filter) {
  ClosedLoop loop(setup);
  const bool paced = options.speed > 0.0;
  const idl::DomainOptions domain = domain_options(setup.unit.dds, options);
  if (idl::ignores_environment(domain))
    spdlog::warn("CYCLONEDDS_URI is set, but the unit file's DDS settings are used");
  const idl::Participant participant(domain);
  const idl::UnitPublisher publisher(
      participant, config::unit_layout(setup.unit),
      paced ? idl::WriterPace::kRealTime : idl::WriterPace::kLossless);
  spdlog::info("unit {} publishes on domain {}", setup.unit.unit,
               options.domain.value_or(setup.unit.dds.domain));
  // Who asks for all that readers can take, or for so many readers, wants none to miss the first.
  constexpr double kPatience = 10.0;
  const bool counts = !paced || options.readers > 1;
  const double patience_s = options.wait_readers_s.value_or(counts ? kPatience : 0.0);
  if (!wait_for_readers(publisher, patience_s, options.readers)) return kDone;

  const std::int64_t samples = options.samples.value_or(std::numeric_limits<std::int64_t>::max());
  const double interval_s = paced ? setup.unit.sample_time_s / options.speed : 0.0;
  const Clock::time_point start = Clock::now();
  bool complained = false;
  for (std::int64_t k = 0; k < samples; ++k) {
    const std::chrono::duration<double> due(static_cast<double>(k) * interval_s);
    if (stopped_before(start + duration_cast<Clock::duration>(due))) {
      spdlog::info("stopped after {} samples", k);
      return kDone;
    }
    const Frame& frame = loop.step();
    if (!loop.finite()) {
      spdlog::error("sample {}: the loop has diverged, values are no longer finite", k);
      return kFailed;
    }
    const Frame* reported = filter.apply(frame);
    if (reported == nullptr || publisher.publish(*reported)) continue;
    if (!paced) {
      spdlog::error("sample {}: a reader does not take samples", k);
      return kFailed;
    }
    if (!complained) spdlog::warn("sample {}: not every topic could be written", k);
    complained = true;
  }
  if (!publisher.flush(kFlushTime)) spdlog::warn("some readers do not have all samples");
  spdlog::info("{} samples published", samples);
  return kDone;
}

}  // namespace mpm::sim
