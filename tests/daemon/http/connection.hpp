#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

namespace mpm::test {

/// A connection to the server, as a browser has one.
class Connection {
 public:
  explicit Connection(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0);
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  Connection(Connection&& other) noexcept : socket_(other.socket_) { other.socket_ = -1; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    if (socket_ >= 0) close(socket_);
  }
  void say(const std::string& text) const {
    (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// Until `end` has come, or the connection ends.
  [[nodiscard]] std::string hear(const std::string& end = "") const {
    std::string text;
    std::array<char, 4096> part{};
    for (;;) {
      const ssize_t got = recv(socket_, part.data(), part.size(), 0);
      if (got <= 0) return text;
      text.append(part.data(), static_cast<std::size_t>(got));
      if (!end.empty() && text.find(end) != std::string::npos) return text;
    }
  }

 private:
  int socket_;
};

}  // namespace mpm::test
