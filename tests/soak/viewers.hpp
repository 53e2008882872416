#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace mpm::soak {

/// Pages that are open on the monitor: each follows its events, one has stopped to read. Whoever is
/// dropped comes back. Now and then one asks for all that the page and a Prometheus ask.
class Viewers {
 public:
  Viewers(int port, std::size_t count);
  Viewers(const Viewers&) = delete;
  Viewers& operator=(const Viewers&) = delete;
  ~Viewers();

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::size_t connections() const { return connections_; }

 private:
  void run();
  void ask(const char* what);

  int port_;
  std::vector<int> sockets_;  // -1: none; the first one is never read
  std::atomic<std::size_t> bytes_ = 0, connections_ = 0;
  std::atomic<bool> stopped_ = false;
  std::thread thread_;
};

}  // namespace mpm::soak
