#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "idl/participant.hpp"
#include "tests/system/process.hpp"

namespace mpm::soak {

/// mpmd with all that it keeps, as a service has it: it is ended in every way, comes back, and is
/// measured.
class Monitor {
 public:
  /// `folder`: with soak.yaml in it. `port`: of its page.
  Monitor(std::string folder, idl::DomainOptions domain, int port, std::uint64_t seed);

  /// Ends it with `signal` and starts the next one. How it ended: exit code, or 128 + signal.
  int restart(int signal);
  /// SIGHUP, SIGSTOP ...
  void send(int signal) const { process_->send(signal); }
  /// While `full` no file of it can grow.
  void fill_disk(bool full) const;
  [[nodiscard]] bool runs();

  /// How many were there before; seconds of the one that runs.
  [[nodiscard]] int lives() const { return lives_; }
  [[nodiscard]] double age_s() const;
  [[nodiscard]] double resident_mb() const;
  [[nodiscard]] double processor_s() const;
  /// Of journal and state folder now, without the journal of alarms; of that; of all logs so far.
  [[nodiscard]] double disk_mb() const;
  [[nodiscard]] double alarm_journal_mb() const;
  [[nodiscard]] double log_kb() const;
  [[nodiscard]] std::string alarm_journal() const { return folder_ + "/state/alarms.sqlite"; }

 private:
  void start();
  [[nodiscard]] std::string log_of(int life) const;

  std::string folder_;
  idl::DomainOptions domain_;
  int port_;
  std::mt19937_64 random_;
  int lives_ = 0;
  double log_kb_before_ = 0.0;
  std::chrono::steady_clock::time_point started_;
  std::optional<test::Process> process_;
};

}  // namespace mpm::soak
