#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm/alarm_command.hpp"
#include "daemon/http/board.hpp"
#include "daemon/http/event_source.hpp"
#include "daemon/http/guard.hpp"
#include "daemon/http/kept_reports.hpp"
#include "daemon/http/unit_json.hpp"

namespace mpm::http {

/// A request without what carries it. Names of headers in lower case.
struct Request {
  std::string method = "GET";
  std::string target = "/";  ///< path and query, still %XX
  std::map<std::string, std::string> headers = {};
  std::string body = {};
  std::string peer = {};  ///< address of who asks
};

struct Reply {
  int status = 200;
  std::string type = "application/json; charset=utf-8";
  std::string body;
  std::map<std::string, std::string> headers = {};
};

/// Answers requests of the API and for the reports; any thread may ask.
class Api {
 public:
  struct Parts {
    const Board* board = nullptr;
    const EventSource* events = nullptr;  ///< null: the board's own
    Guard guard{{}, std::nullopt};
    KeptReports reports{""};
    std::string version;
    std::function<CommandReply(const AlarmCommand&)> command;  ///< empty: none are carried out
    /// Told of commands that were refused for want of the token, and why; may be empty.
    std::function<void(const AlarmCommand&, const std::string&)> refused;
    std::function<Json()> server;  ///< what the server tells of itself; may be empty
  };

  explicit Api(Parts parts);

  /// Of what is addressed to us (`refusal`), without the event stream.
  [[nodiscard]] Reply answer(const Request& request) const;
  /// Whether a request is to be answered at all: an error, or nothing.
  [[nodiscard]] std::optional<Reply> refusal(const Request& request) const;
  [[nodiscard]] const Guard& guard() const { return parts_.guard; }

 private:
  using Query = std::map<std::string, std::string>;

  [[nodiscard]] Reply get(const std::vector<std::string>& path, const Query& query) const;
  [[nodiscard]] Reply unit(const std::vector<std::string>& path, const Query& query) const;
  [[nodiscard]] Reply cv(const UnitStore& store, int cv, const std::string& what,
                         const Query& query) const;
  [[nodiscard]] Reply units() const;
  [[nodiscard]] Reply journal(const Query& query) const;
  [[nodiscard]] Reply system() const;
  [[nodiscard]] Reply ready() const;
  [[nodiscard]] Reply metrics() const;
  [[nodiscard]] Reply report(const std::vector<std::string>& path) const;
  [[nodiscard]] Reply command(const Request& request) const;

  Parts parts_;
  std::int64_t started_ns_;
};

/// An error as the API gives it: {"error": text}.
[[nodiscard]] Reply error_reply(int status, const std::string& text);

}  // namespace mpm::http
