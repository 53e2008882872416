#include "daemon/http/server.hpp"

#include <httplib.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "daemon/http/assets.hpp"
#include "daemon/http/event_stream.hpp"
#include "daemon/http/intake.hpp"
#include "daemon/http/worker_queue.hpp"

namespace mpm::http {
namespace {

constexpr std::size_t kWorkers = 8;  // beside the threads of the streams
constexpr std::size_t kMostWaiting = 64;
constexpr std::chrono::seconds kWriteTimeout{5};
// The kernel's queue of connections that nobody has accepted yet; the library's own is five.
constexpr int kBacklog = 128;

// No inline script or style, nothing from elsewhere, nobody's frame.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' "
    "data:; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What goes with each answer.
const httplib::Headers& headers() {
  static const httplib::Headers all{
      {"Content-Security-Policy", kPagePolicy},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"},
      {"Cache-Control", "no-store"}};
  return all;
}

/// What the library has accepted is handed to the intake at once, in its thread.
class AtOnce : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> job) override { job(); }
  void shutdown() override {}
};

/// A request that is there already, to be read, and its connection, to be written to.
class Exchange : public httplib::Stream {
 public:
  Exchange(int socket, const std::string& head) : socket_(socket), head_(head) {}

  [[nodiscard]] bool is_readable() const override { return read_ < head_.size(); }
  [[nodiscard]] bool is_writable() const override {
    pollfd polled{socket_, POLLOUT, 0};
    const auto wait = std::chrono::milliseconds(kWriteTimeout).count();
    if (poll(&polled, 1, static_cast<int>(wait)) <= 0) return false;
    char next = 0;  // who has gone has ended what he says
    return recv(socket_, &next, 1, MSG_PEEK | MSG_DONTWAIT) != 0;
  }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = head_.copy(to, size, read_);
    read_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    return ::send(socket_, from, size, MSG_NOSIGNAL);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    name(getpeername, ip, port);
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    name(getsockname, ip, port);
  }
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  void name(int (*ask)(int, sockaddr*, socklen_t*), std::string& ip, int& port) const {
    sockaddr_storage place{};
    socklen_t length = sizeof place;
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    auto* address = reinterpret_cast<sockaddr*>(&place);
    if (ask(socket_, address, &length) != 0 ||
        getnameinfo(address, length, host.data(), host.size(), service.data(), service.size(),
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0)
      return;
    ip = host.data();
    port = std::atoi(service.data());
  }

  int socket_;
  const std::string& head_;
  std::size_t read_ = 0;
};

/// The library, of which we use how it accepts connections, reads headers and writes answers: it
/// reads requests without bounds.
class Front : public httplib::Server {
 public:
  std::function<void(int socket)> accepted;

  /// Answers, and ends the connection. Whatever is thrown ends this connection only.
  void answer(int socket, RawRequest& request) {
    try {
      Exchange exchange(socket, request.head);
      bool closed = false;
      (void)process_request(exchange, true, closed, [&request](httplib::Request& given) {
        given.body = std::move(request.body);
        given.headers.erase("Expect");  // answered by the intake
      });
    } catch (...) {
    }
    shutdown(socket, SHUT_RDWR);
    close(socket);
  }
  void deepen_backlog() { (void)::listen(svr_sock_, kBacklog); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    try {
      accepted(socket);
    } catch (...) {
      close(socket);
    }
    return true;
  }
};

const char* phrase(int status) {
  switch (status) {
    case 400:
      return "Bad Request";
    case 408:
      return "Request Timeout";
    case 411:
      return "Length Required";
    case 413:
      return "Payload Too Large";
    case 431:
      return "Request Header Fields Too Large";
    default:
      return "Service Unavailable";
  }
}

/// A reply to what the library never sees.
std::string whole_text(const Reply& reply) {
  std::string text = "HTTP/1.1 " + std::to_string(reply.status) + " " + phrase(reply.status);
  for (const auto& [name, value] : headers()) text += "\r\n" + name + ": " + value;
  return text + "\r\nContent-Type: " + reply.type +
         "\r\nContent-Length: " + std::to_string(reply.body.size()) +
         "\r\nConnection: close\r\n\r\n" + reply.body;
}

std::string lower(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

Request request_of(const httplib::Request& given) {
  Request request;
  request.method = given.method;
  request.target = given.target;
  for (const auto& [name, value] : given.headers) request.headers.emplace(lower(name), value);
  request.body = given.body;
  request.peer = given.remote_addr;
  return request;
}

/// The library sends a part that is asked for without a look at where the answer ends: it is not
/// asked. The request is its own, and not const.
void ask_for_all(const httplib::Request& given) {
  const_cast<httplib::Request&>(given).ranges.clear();
}

/// As it is, without the library's compression, which costs more than the network here.
void send(httplib::Response& response, const std::string& type,
          std::shared_ptr<const std::string> body) {
  if (body->empty()) {
    response.set_header("Content-Type", type);
    return;
  }
  const std::size_t length = body->size();
  response.set_content_provider(
      length, type, [body = std::move(body)](std::size_t from, std::size_t count, auto& sink) {
        return sink.write(body->data() + from, count);
      });
}

void set_header(httplib::Response& response, const std::string& name, const std::string& value) {
  response.headers.erase(name);  // a default
  response.set_header(name, value);
}

std::string run_name() {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count());
}

}  // namespace

struct Server::Parts {
  Parts(const Address& given, Board& all, Api::Parts api_parts)
      : address(given), board(all), api(completed(std::move(api_parts))) {}

  Api::Parts completed(Api::Parts parts_of_api) {
    parts_of_api.server = [this] {
      return Json{{"streams", streams.load()},
                  {"most_streams", kMostStreams},
                  {"requests", requests.load()},
                  {"refused", refused.load()}};
    };
    return parts_of_api;
  }

  void set_up();
  bool hand_over(int socket, RawRequest request);
  void answer(const httplib::Request& given, httplib::Response& response);
  void send_asset(const Asset& asset, const httplib::Request& given, httplib::Response& response);
  void stream(const Request& request, httplib::Response& response);
  void reply(const Reply& answered, httplib::Response& response);

  Address address;
  Board& board;
  std::atomic<std::size_t> streams = 0;
  std::atomic<std::uint64_t> requests = 0, refused = 0;
  Api api;
  std::string run = run_name();
  Front server;
  WorkerQueue workers{kWorkers + kMostStreams, kMostWaiting};
  std::unique_ptr<Intake> intake;
  std::thread listener;
};

void Server::Parts::set_up() {
  server.new_task_queue = [] { return new AtOnce; };
  server.accepted = [this](int socket) { intake->add(socket); };
  intake = std::make_unique<Intake>(
      Intake::Limits{},
      [this](int socket, RawRequest request) { return hand_over(socket, std::move(request)); },
      [this](int status, const char* why) {
        ++requests;
        ++refused;
        return whole_text(error_reply(status, why));
      });
  // The library's own would let a second monitor share the port unseen.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_write_timeout(kWriteTimeout);
  server.set_default_headers(headers());
  // All is answered before the library looks for whom to ask, and so before it reads a body.
  server.set_pre_routing_handler(
      [this](const httplib::Request& given, httplib::Response& response) {
        ask_for_all(given);
        answer(given, response);
        return httplib::Server::HandlerResponse::Handled;
      });
  // Of the errors that the library finds.
  server.set_error_handler([this](const httplib::Request& given, httplib::Response& response) {
    ask_for_all(given);
    if (response.has_header("Content-Type")) return;
    ++refused;
    reply(error_reply(response.status, response.status == 414
                                           ? "the first line is longer than 8192 bytes"
                                           : "the request cannot be read"),
          response);
  });
  server.set_exception_handler(
      [this](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
        reply(error_reply(500, "the monitor could not answer this"), response);
      });
}

bool Server::Parts::hand_over(int socket, RawRequest request) {
  return workers.add(
      [this, socket, request = std::move(request)]() mutable { server.answer(socket, request); });
}

void Server::Parts::answer(const httplib::Request& given, httplib::Response& response) {
  ++requests;
  const Request request = request_of(given);
  const std::string path = request.target.substr(0, request.target.find('?'));
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (const std::optional<Reply> refusal = api.refusal(request)) {
    ++refused;
    return reply(*refusal, response);
  }
  if (reads && path == "/api/v1/events") return stream(request, response);
  if (const Asset* asset = reads ? find_asset(path) : nullptr)
    return send_asset(*asset, given, response);
  reply(api.answer(request), response);
}

void Server::Parts::reply(const Reply& answered, httplib::Response& response) {
  response.status = answered.status;
  for (const auto& [name, value] : answered.headers) set_header(response, name, value);
  send(response, answered.type, std::make_shared<const std::string>(answered.body));
}

void Server::Parts::send_asset(const Asset& asset, const httplib::Request& given,
                               httplib::Response& response) {
  set_header(response, "Cache-Control", "no-cache");  // asked each time, sent once
  set_header(response, "ETag", std::string(asset.etag));
  if (given.get_header_value("If-None-Match") == asset.etag) {
    response.status = 304;
    return;
  }
  send(response, std::string(asset.type), std::make_shared<const std::string>(asset.bytes));
}

void Server::Parts::stream(const Request& request, httplib::Response& response) {
  if (streams.fetch_add(1) >= kMostStreams) {
    --streams;
    ++refused;
    Reply full = error_reply(503, "as many pages are open as this monitor serves");
    full.headers["Retry-After"] = "10";
    return reply(full, response);
  }
  const auto last = request.headers.find("last-event-id");
  const auto events =
      std::make_shared<EventStream>(board, run, last == request.headers.end() ? "" : last->second);
  response.set_chunked_content_provider(
      "text/event-stream",
      [events](std::size_t, httplib::DataSink& sink) {
        bool ended = false;
        const std::string text = events->next(ended);
        return !ended && (text.empty() || sink.write(text.data(), text.size()));
      },
      [this](bool) { --streams; });
}

Server::Server(const Address& address, Board& board, Api::Parts parts)
    : parts_(std::make_unique<Parts>(address, board, std::move(parts))) {
  parts_->set_up();
  errno = 0;
  Address& own = parts_->address;
  const bool bound = own.port == 0 ? (own.port = parts_->server.bind_to_any_port(own.host)) > 0
                                   : parts_->server.bind_to_port(own.host, own.port);
  if (!bound)
    throw std::runtime_error("cannot listen on " + address.host + ":" +
                             std::to_string(address.port) + ": " + bind_problem(errno));
  parts_->server.deepen_backlog();
}

void Server::start() {
  parts_->listener = std::thread([this] { parts_->server.listen_after_bind(); });
}

Server::~Server() {
  parts_->board.close();  // ends the streams
  // `stop` before `listen` has begun would be lost.
  while (parts_->listener.joinable() && !parts_->server.is_running())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  parts_->server.stop();
  if (parts_->listener.joinable()) parts_->listener.join();
  parts_->intake.reset();  // it hands over what the workers then answer
  parts_->workers.finish();
}

const Address& Server::address() const { return parts_->address; }

}  // namespace mpm::http
