#include "daemon/http/server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "daemon/http/assets.hpp"
#include "daemon/http/event_stream.hpp"
#include "daemon/http/worker_queue.hpp"

namespace mpm::http {
namespace {

constexpr std::size_t kWorkers = 8;  // beside the threads of the streams
constexpr std::size_t kMostWaiting = 64;
constexpr std::size_t kMostBody = 16'384;        // bytes: a command and a comment
constexpr std::chrono::seconds kReadTimeout{5};  // between two bytes
constexpr std::chrono::seconds kWriteTimeout{5};
constexpr std::chrono::seconds kIdle{2};  // a browser opens connections that it may not need

// No inline script or style, nothing from elsewhere, nobody's frame.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' "
    "data:; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The library's interface to our threads.
class Tasks : public httplib::TaskQueue {
 public:
  Tasks() : queue_(kWorkers + Server::kMostStreams, kMostWaiting) {}
  void enqueue(std::function<void()> job) override { queue_.add(std::move(job)); }
  void shutdown() override { queue_.finish(); }

 private:
  WorkerQueue queue_;
};

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
  httplib::Server server;
  std::thread listener;
};

void Server::Parts::set_up() {
  server.new_task_queue = [] { return new Tasks; };
  // The library's own would let a second monitor share the port unseen.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_keep_alive_max_count(1);  // a connection at rest would hold a thread
  server.set_keep_alive_timeout(kIdle.count());
  server.set_read_timeout(kReadTimeout);
  server.set_write_timeout(kWriteTimeout);
  server.set_payload_max_length(kMostBody);
  server.set_default_headers({{"Content-Security-Policy", kPagePolicy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"},
                              {"Cache-Control", "no-store"}});
  const auto handler = [this](const httplib::Request& given, httplib::Response& response) {
    answer(given, response);
  };
  constexpr const char* kAll = ".*";
  server.Get(kAll, handler);
  server.Post(kAll, handler);
  server.Put(kAll, handler);
  server.Patch(kAll, handler);
  server.Delete(kAll, handler);
  server.Options(kAll, handler);
  server.set_exception_handler(
      [this](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
        reply(error_reply(500, "the monitor could not answer this"), response);
      });
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
  Address& own = parts_->address;
  const bool bound = own.port == 0 ? (own.port = parts_->server.bind_to_any_port(own.host)) > 0
                                   : parts_->server.bind_to_port(own.host, own.port);
  if (!bound)
    throw std::runtime_error("cannot listen on " + address.host + ":" +
                             std::to_string(address.port) +
                             ": the port is taken, or the address is none of this machine");
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
}

const Address& Server::address() const { return parts_->address; }

}  // namespace mpm::http
