#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "daemon/http/server.hpp"
#include "tests/daemon/http/sample_board.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

/// A server of two hours of a unit with an alarm, which carries out every command.
struct Served {
  Served() : server(http::Address{}, sample.board, parts()) {
    sample.board.start();
    sample.push(120);
    sample.show(true);
    server.start();
  }
  http::Api::Parts parts() {
    http::Api::Parts parts;
    parts.board = &sample.board;
    parts.guard = http::Guard({}, host::CommandToken("a token of the tests"));
    parts.version = "fuzz";
    parts.command = [](const AlarmCommand&) { return CommandReply{true, "done"}; };
    return parts;
  }
  test::SampleBoard sample;
  http::Server server;
};

/// What is answered to what is said, up to the end of the connection or the begin of a stream.
std::string answer(int port, std::string_view bytes) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto connects = [&] {
    return connect(connection, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0 ||
           errno == EISCONN;
  };
  // All ports are waiting, or the fuzzer's clock has interrupted it.
  while (!connects() && (errno == EADDRNOTAVAIL || errno == EINTR || errno == EALREADY))
    usleep(10'000);
  require(connects(), "the server takes no connection");
  const linger at_once{1, 0};  // or all ports are waiting soon
  setsockopt(connection, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  const timeval patience{20, 0};
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  static_cast<void>(!send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  shutdown(connection, SHUT_WR);
  std::string text;
  std::array<char, 65536> part{};
  ssize_t got = 0;
  while ((got = recv(connection, part.data(), part.size(), 0)) > 0) {
    text.append(part.data(), static_cast<std::size_t>(got));
    if (text.find("text/event-stream") != std::string::npos) break;
  }
  const bool silent = got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
  close(connection);
  require(!silent, "a connection that neither answers nor ends");
  return text;
}

}  // namespace

void http(std::string_view bytes) {
  static Served served;
  const std::string text = answer(served.server.address().port, bytes);
  if (text.empty()) return;
  require(text.starts_with("HTTP/1.1 "), "no answer of HTTP");
  require(!text.starts_with("HTTP/1.1 500"), "the server could not answer");
  const std::size_t body = text.find("\r\n\r\n");
  require(body != std::string::npos, "an answer without an end of its headers");
  if (text.find("Content-Type: application/json") < body && body + 4 < text.size())
    require(nlohmann::json::accept(text.substr(body + 4)), "JSON that is none");
}

}  // namespace mpm::fuzz
