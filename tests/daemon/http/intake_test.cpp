#include "daemon/http/intake.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "idl/condition_variable.hpp"

namespace mpm::http::intake_test {
namespace {

using namespace std::chrono_literals;

/// Somebody who asks: the intake has the other end of the line.
class Client {
 public:
  explicit Client(Intake& intake) {
    std::array<int, 2> ends{};
    REQUIRE(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
    socket_ = ends[0];
    intake.add(ends[1]);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { close(socket_); }
  void say(const std::string& text) const {
    (void)!send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// What comes next; empty when the line has ended.
  [[nodiscard]] std::string hear_some() const {
    std::array<char, 256> part{};
    const ssize_t got = recv(socket_, part.data(), part.size(), 0);
    return {part.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
  }
  /// Until the line has ended.
  [[nodiscard]] std::string hear() const {
    std::string text;
    for (std::string part = hear_some(); !part.empty(); part = hear_some()) text += part;
    return text;
  }

 private:
  int socket_ = -1;
};

struct Bench {
  explicit Bench(const Intake::Limits& limits = {}) : intake(limits, ready(), refusal()) {}
  ~Bench() {
    for (const int socket : sockets) close(socket);
  }
  Intake::Ready ready() {
    return [this](int socket, RawRequest request) {
      const MutexLock lock(mutex);
      if (busy) return false;
      sockets.push_back(socket);
      requests.push_back(std::move(request));
      changed.notify_all();
      return true;
    };
  }
  static Intake::Refusal refusal() {
    return [](int status, const char*) { return std::to_string(status); };
  }
  RawRequest next() {
    MutexLock lock(mutex);
    while (requests.empty()) changed.wait(lock);
    RawRequest first = requests.front();
    requests.pop_front();
    return first;
  }

  Mutex mutex;
  ConditionVariable changed;
  std::vector<int> sockets;
  std::deque<RawRequest> requests;
  bool busy = false;
  Intake intake;
};

TEST_CASE("a request is handed over when all of it is there") {
  Bench bench;
  const Client client(bench.intake);
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\ncontent-length:  5 \r\n\r\n";
  for (const char letter : head + "12345and more") client.say({letter});
  const RawRequest request = bench.next();
  CHECK(request.head == head);
  CHECK(request.body == "12345");
  const Client other(bench.intake);
  other.say("GET / HTTP/1.1\r\n\r\n");
  CHECK(bench.next().body.empty());
}

TEST_CASE("more than a request may have is refused") {
  Bench bench;
  const auto said = [&bench](const std::string& text) {
    const Client client(bench.intake);
    client.say(text);
    return client.hear();
  };
  const std::string line = "GET / HTTP/1.1\r\n", end = "\r\n\r\n";
  CHECK(said(line + "X: " + std::string(Intake::kMostHead, 'a') + end) == "431");
  CHECK(said(std::string(2 * Intake::kMostHead, 'a')) == "431");
  CHECK(said(line + "Content-Length: 16385" + end) == "413");
  CHECK(said(line + "Content-Length: -1" + end) == "400");
  CHECK(said(line + "Content-Length:" + end) == "400");
  CHECK(said(line + "Content-Length: 1\r\nContent-Length: 2" + end) == "400");
  CHECK(said(line + "Content-Length: 99999999999999999999999" + end) == "400");
  CHECK(said(line + "Transfer-Encoding: chunked" + end) == "411");
  const Client most(bench.intake);
  most.say(line + "Content-Length: 16384\r\nX: " + std::string(16'000, 'a') + end +
           std::string(Intake::kMostBody, 'b'));
  CHECK(bench.next().body.size() == Intake::kMostBody);
}

TEST_CASE("who waits to be asked for the body is asked") {
  Bench bench;
  const Client client(bench.intake);
  client.say("POST / HTTP/1.1\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  CHECK(client.hear_some() == "HTTP/1.1 100 Continue\r\n\r\n");
  client.say("ab");
  CHECK(bench.next().body == "ab");
}

TEST_CASE("a request that drips is given up, and so is a line on which nothing is said") {
  Bench bench({256, 50ms});
  const Client dripping(bench.intake), silent(bench.intake);
  dripping.say("GET / HT");
  CHECK(dripping.hear() == "408");
  CHECK(silent.hear().empty());
}

TEST_CASE("where all places are taken the one that waits longest is given up") {
  Bench bench({2, 1h});
  const Client first(bench.intake);
  first.say("GET /1 ");
  const Client second(bench.intake), third(bench.intake);
  CHECK(first.hear().empty());
  third.say("GET /3 HTTP/1.1\r\n\r\n");
  CHECK(bench.next().head == "GET /3 HTTP/1.1\r\n\r\n");
  second.say("GET /2 HTTP/1.1\r\n\r\n");
  CHECK(bench.next().head == "GET /2 HTTP/1.1\r\n\r\n");
}

TEST_CASE("what nobody can answer now is refused") {
  Bench bench;
  {
    const MutexLock lock(bench.mutex);
    bench.busy = true;
  }
  const Client client(bench.intake);
  client.say("GET / HTTP/1.1\r\n\r\n");
  CHECK(client.hear() == "503");
}

TEST_CASE("an intake ends with lines open") {
  auto bench = std::make_unique<Bench>();
  const Client client(bench->intake);
  client.say("GET / HT");
  bench.reset();
  CHECK(client.hear().empty());
}

}  // namespace
}  // namespace mpm::http::intake_test
