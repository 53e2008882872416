#include "tests/soak/viewers.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>

namespace mpm::soak {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kBetweenTries{1};

/// A connection on which that has been asked; -1 where nobody listens.
int asked(int port, const std::string& what) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    close(connection);
    return -1;
  }
  const std::string request = "GET " + what + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  static_cast<void>(!send(connection, request.data(), request.size(), MSG_NOSIGNAL));
  return connection;
}

}  // namespace

Viewers::Viewers(int port, std::size_t count)
    : port_(port), sockets_(count, -1), thread_([this] { run(); }) {}

Viewers::~Viewers() {
  stopped_ = true;
  thread_.join();
  for (const int connection : sockets_)
    if (connection >= 0) close(connection);
}

void Viewers::ask(const char* what) {
  const int connection = asked(port_, what);
  if (connection < 0) return;
  const timeval patience{2, 0};
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::array<char, 65536> part{};
  for (ssize_t got = 0; (got = recv(connection, part.data(), part.size(), 0)) > 0;)
    bytes_ += static_cast<std::size_t>(got);
  close(connection);
}

void Viewers::run() {
  Clock::time_point next_try{};
  std::array<char, 65536> part{};
  while (!stopped_) {
    if (Clock::now() >= next_try) {
      next_try = Clock::now() + kBetweenTries;
      for (int& connection : sockets_)
        if (connection < 0 && (connection = asked(port_, "/api/v1/events")) >= 0) ++connections_;
      for (const char* what : {"/api/v1/units", "/api/v1/units/soak", "/metrics"}) ask(what);
    }
    std::vector<pollfd> open;
    for (std::size_t i = 1; i < sockets_.size(); ++i) open.push_back({sockets_[i], POLLIN, 0});
    poll(open.data(), open.size(), 100);
    for (std::size_t i = 1; i < sockets_.size(); ++i) {
      if ((open[i - 1].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
      const ssize_t got = recv(sockets_[i], part.data(), part.size(), 0);
      if (got > 0) {
        bytes_ += static_cast<std::size_t>(got);
        continue;
      }
      close(sockets_[i]);
      sockets_[i] = -1;
    }
    // The one that does not read sees by its end alone that it was dropped.
    pollfd stopped{sockets_[0], POLLRDHUP, 0};
    if (sockets_[0] >= 0 && poll(&stopped, 1, 0) > 0) {
      close(sockets_[0]);
      sockets_[0] = -1;
    }
  }
}

}  // namespace mpm::soak
