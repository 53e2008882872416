#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel/mutex.hpp"

namespace mpm::http {

/// A request as it came: its first line and headers with the empty line that ends them, and its
/// body.
struct RawRequest {
  std::string head, body;
};

/// Connections whose requests are not all there yet. One thread reads from all of them, so that who
/// is slow holds up nobody: what he takes is a place among many, bounded in bytes and in time, and
/// where all are taken the one that has waited longest is given up. A client that means well says
/// all it has to say at once.
class Intake {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostHead = 16'384, kMostBody = 16'384;  ///< bytes
  struct Limits {
    std::size_t connections = 256;
    std::chrono::milliseconds patience{5000};  ///< for the whole request
  };
  /// Given a socket, which is its own from then on, and its request; false: it is not taken, for
  /// all are busy.
  using Ready = std::function<bool(int socket, RawRequest request)>;
  /// The whole reply to a request that is refused.
  using Refusal = std::function<std::string(int status, const char* why)>;

  Intake(const Limits& limits, Ready ready, Refusal refusal);
  Intake(const Intake&) = delete;
  Intake& operator=(const Intake&) = delete;
  /// Closes what has not been handed over.
  ~Intake();

  /// From any thread, without waiting. The socket is the intake's from then on.
  void add(int socket);

 private:
  struct Connection {
    int socket;
    Clock::time_point deadline;
    std::string text = {};
    std::size_t head = 0, body = 0;  // bytes, once the head is whole
    bool refused = false;            // what still comes is thrown away
    std::size_t thrown = 0;          // bytes
  };

  void run();
  void take_arrivals();
  void give_up_late(Clock::time_point now);
  /// Whether the connection stays here.
  [[nodiscard]] bool hear(Connection& connection);
  [[nodiscard]] bool advance(Connection& connection, std::size_t known);
  void refuse(Connection& connection, int status, const char* why) const;

  Limits limits_;
  Ready ready_;
  Refusal refusal_;
  int wake_;
  std::vector<Connection> connections_;  // of the thread, the oldest first
  Mutex mutex_;
  std::vector<int> arrivals_ MPM_GUARDED_BY(mutex_);
  bool finished_ MPM_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace mpm::http
