#include "daemon/http/intake.hpp"

#include <poll.h>
#include <strings.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace mpm::http {
namespace {

constexpr std::string_view kEnd = "\r\n\r\n";
// Of who is refused, so that he reads why before the connection ends.
constexpr std::size_t kMostThrown = 1'000'000;  // bytes

/// Of the lines of a head those that the length of the body is told by.
struct Framing {
  std::optional<std::size_t> length;
  bool broken = false, chunked = false, expects_continue = false;
};

bool is_named(std::string_view line, std::string_view name) {
  return line.size() > name.size() && line[name.size()] == ':' &&
         strncasecmp(line.data(), name.data(), name.size()) == 0;
}

std::string_view value_of(std::string_view line) {
  line.remove_prefix(line.find(':') + 1);
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(" \t") + 1 - begin);
}

Framing framing_of(std::string_view head) {
  Framing framing;
  for (std::size_t at = 0; at < head.size();) {
    const std::size_t end = std::min(head.find("\r\n", at), head.size());
    const std::string_view line = head.substr(at, end - at);
    at = end + 2;
    framing.chunked |= is_named(line, "transfer-encoding");
    framing.expects_continue |= is_named(line, "expect");
    if (!is_named(line, "content-length")) continue;
    const std::string_view value = value_of(line);
    std::size_t length = 0;
    const auto [last, error] = std::from_chars(value.data(), value.data() + value.size(), length);
    const bool whole = error == std::errc() && last == value.data() + value.size();
    // Said twice, it is to be said alike: who stands in front might take the other one.
    framing.broken |= !whole || (framing.length && *framing.length != length);
    framing.length = length;
  }
  return framing;
}

/// Without waiting: a buffer that takes no line has a reader who reads nothing.
void say(int socket, std::string_view text) {
  (void)!send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace

Intake::Intake(const Limits& limits, Ready ready, Refusal refusal)
    : limits_(limits),
      ready_(std::move(ready)),
      refusal_(std::move(refusal)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_ < 0) throw std::runtime_error("cannot wait for requests: no more files may be open");
  connections_.reserve(limits.connections + 1);
  thread_ = std::thread([this] { run(); });
}

Intake::~Intake() {
  {
    const MutexLock lock(mutex_);
    finished_ = true;
  }
  eventfd_write(wake_, 1);
  thread_.join();
  for (const Connection& each : connections_) close(each.socket);
  for (const int socket : arrivals_) close(socket);
  close(wake_);
}

void Intake::add(int socket) {
  {
    const MutexLock lock(mutex_);
    if (arrivals_.size() >= limits_.connections) {
      close(arrivals_.front());
      arrivals_.erase(arrivals_.begin());
    }
    arrivals_.push_back(socket);
  }
  eventfd_write(wake_, 1);
}

void Intake::run() {
  std::vector<pollfd> polled;
  polled.reserve(limits_.connections + 1);
  for (;;) {
    take_arrivals();
    {
      const MutexLock lock(mutex_);
      if (finished_) return;
    }
    const Clock::time_point now = Clock::now();
    give_up_late(now);
    polled.assign(1, {wake_, POLLIN, 0});
    for (const Connection& each : connections_) polled.push_back({each.socket, POLLIN, 0});
    const auto wait =
        connections_.empty()
            ? std::chrono::milliseconds(-1)
            : std::chrono::ceil<std::chrono::milliseconds>(connections_.front().deadline - now);
    if (poll(polled.data(), polled.size(), static_cast<int>(wait.count())) <= 0) continue;
    eventfd_t woken = 0;
    if (polled[0].revents != 0) eventfd_read(wake_, &woken);
    std::size_t at = 0;
    std::erase_if(connections_,
                  [&](Connection& each) { return polled[++at].revents != 0 && !hear(each); });
  }
}

void Intake::take_arrivals() {
  const MutexLock lock(mutex_);
  for (const int socket : arrivals_) {
    if (connections_.size() >= limits_.connections) {
      close(connections_.front().socket);
      connections_.erase(connections_.begin());
    }
    connections_.push_back({socket, Clock::now() + limits_.patience});
  }
  arrivals_.clear();
}

void Intake::give_up_late(Clock::time_point now) {
  std::erase_if(connections_, [&](Connection& each) {
    if (each.deadline > now) return false;
    // A browser opens connections that it may not need: who has said nothing is told nothing.
    if (!each.refused && !each.text.empty())
      refuse(each, 408, "the request was not there within five seconds");
    close(each.socket);
    return true;
  });
}

bool Intake::hear(Connection& connection) {
  try {
    std::array<char, 4096> part;
    const ssize_t got = recv(connection.socket, part.data(), part.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
    if (got > 0) {
      const std::size_t known = connection.text.size();
      if (connection.refused)
        connection.thrown += static_cast<std::size_t>(got);
      else
        connection.text.append(part.data(), static_cast<std::size_t>(got));
      if (connection.refused ? connection.thrown <= kMostThrown : advance(connection, known))
        return true;
    }
  } catch (const std::exception&) {
    // The same: it costs this connection and nothing else.
  }
  if (connection.socket >= 0) close(connection.socket);
  return false;
}

bool Intake::advance(Connection& connection, std::size_t known) {
  std::string& text = connection.text;
  if (connection.head == 0) {
    const std::size_t end = text.find(kEnd, known < kEnd.size() ? 0 : known - kEnd.size());
    if (std::min(end, text.size()) > kMostHead) {
      refuse(connection, 431, "the first line and the headers are longer than 16384 bytes");
      return true;
    }
    if (end == std::string::npos) return true;
    const Framing framing = framing_of(std::string_view(text).substr(0, end));
    connection.head = end + kEnd.size();
    connection.body = framing.length.value_or(0);
    if (framing.broken)
      refuse(connection, 400, "Content-Length is no number of bytes");
    else if (framing.chunked)
      refuse(connection, 411, "a body is to have a Content-Length");
    else if (connection.body > kMostBody)
      refuse(connection, 413, "the body is longer than 16384 bytes");
    else if (framing.expects_continue && text.size() < connection.head + connection.body)
      say(connection.socket, "HTTP/1.1 100 Continue\r\n\r\n");
    if (connection.refused) return true;
  }
  if (text.size() < connection.head + connection.body) return true;
  RawRequest request{text.substr(0, connection.head),
                     text.substr(connection.head, connection.body)};
  if (!ready_(connection.socket, std::move(request))) {
    refuse(connection, 503, "more is asked for than this monitor can answer");
    return true;
  }
  connection.socket = -1;
  return false;
}

void Intake::refuse(Connection& connection, int status, const char* why) const {
  try {
    say(connection.socket, refusal_(status, why));
  } catch (const std::exception&) {
    // Memory is short: the connection ends without a word.
  }
  shutdown(connection.socket, SHUT_WR);
  connection.refused = true;
  connection.text = {};
}

}  // namespace mpm::http
