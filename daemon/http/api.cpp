#include "daemon/http/api.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "core/signal/nanoseconds.hpp"
#include "core/text/printable.hpp"
#include "daemon/http/command_json.hpp"
#include "daemon/http/diagnosis_json.hpp"
#include "daemon/http/metrics.hpp"
#include "daemon/http/series_json.hpp"
#include "daemon/http/system_json.hpp"
#include "daemon/http/target.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::http {
namespace {

constexpr int kMostEvents = 5000;

Reply json_reply(const Json& json, int status = 200) {
  Reply reply;
  reply.status = status;
  reply.body = report::json_text(json);
  return reply;
}

/// Of a query; `bad` where it is there and no number.
template <class Number>
std::optional<Number> number_of(const std::map<std::string, std::string>& query, const char* key,
                                bool& bad) {
  const auto found = query.find(key);
  if (found == query.end() || found->second.empty()) return std::nullopt;
  Number value{};
  const char* end = found->second.data() + found->second.size();
  const auto [at, error] = std::from_chars(found->second.data(), end, value);
  if (error != std::errc() || at != end || !std::isfinite(static_cast<double>(value))) {
    bad = true;
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> moment_of(const std::map<std::string, std::string>& query,
                                      const char* key, bool& bad) {
  constexpr double kMost = 9e9;  // s: what whole ns can count
  const auto seconds = number_of<double>(query, key, bad);
  if (!seconds) return std::nullopt;
  return std::llround(std::clamp(*seconds, -kMost, kMost) * kNsPerSecond);
}

std::string header(const Request& request, const char* name) {
  const auto found = request.headers.find(name);
  return found == request.headers.end() ? "" : found->second;
}

bool is_within(int value, int least, int most) { return value >= least && value <= most; }

/// A method that is not for what is asked for.
Reply method_reply(const std::string& text, const char* allowed) {
  Reply reply = error_reply(405, text);
  reply.headers["Allow"] = allowed;
  return reply;
}

std::string text_of(const std::map<std::string, std::string>& query, const char* key) {
  const auto found = query.find(key);
  return found == query.end() ? "" : found->second;
}

}  // namespace

Reply error_reply(int status, const std::string& text) {
  return json_reply({{"error", text}}, status);
}

Api::Api(Parts parts)
    : parts_(std::move(parts)),
      started_ns_(std::chrono::duration_cast<std::chrono::nanoseconds>(
                      std::chrono::system_clock::now().time_since_epoch())
                      .count()) {}

std::optional<Reply> Api::refusal(const Request& request) const {
  if (!parts_.guard.is_addressed(header(request, "host")))
    return error_reply(421,
                       "this server is not known by the name in the Host header; --http-name "
                       "says what else it is called");
  if (request.method == "GET" || request.method == "HEAD") return std::nullopt;
  if (request.method != "POST")
    return method_reply("only GET, HEAD and POST are answered", "GET, HEAD, POST");
  if (!Guard::is_own(header(request, "origin"), header(request, "sec-fetch-site"),
                     header(request, "host")))
    return error_reply(403, "requests of other sites' pages are refused");
  return std::nullopt;
}

Reply Api::answer(const Request& request) const {
  if (std::optional<Reply> refused = refusal(request)) return *refused;
  const std::optional<Target> target = parse_target(request.target);
  if (!target) return error_reply(400, "the path cannot be read");
  if (request.method == "POST") {
    if (target->path == std::vector<std::string>{"api", "v1", "commands"}) return command(request);
    return method_reply("only /api/v1/commands takes a POST", "GET, HEAD");
  }
  return get(target->path, target->query);
}

Reply Api::get(const std::vector<std::string>& path, const Query& query) const {
  if (path.size() == 1 && path[0] == "healthz") return json_reply({{"status", "ok"}});
  if (path.size() == 1 && path[0] == "readyz") return ready();
  if (path.size() == 1 && path[0] == "metrics") return metrics();
  if (!path.empty() && path[0] == "reports") return report(path);
  if (path.size() < 3 || path[0] != "api" || path[1] != "v1")
    return error_reply(404, "there is nothing of this name");
  if (path[2] == "units") return path.size() == 3 ? units() : unit(path, query);
  if (path.size() == 3 && path[2] == "journal") return journal(query);
  if (path.size() == 3 && path[2] == "system") return system();
  if (path.size() == 3 && path[2] == "commands")
    return method_reply("commands are given with POST", "POST");
  return error_reply(404, "there is nothing of this name");
}

Reply Api::units() const {
  std::vector<Json> cards;
  for (const auto& [name, unit] : parts_.board->units())
    cards.push_back(overview_json(unit->store));
  // What needs somebody first; then those with most to look at, and by name.
  std::stable_sort(cards.begin(), cards.end(), [](const Json& a, const Json& b) {
    for (const char* key : {"attention", "alarms", "mismatch"})
      if (a[key] != b[key]) return a[key].get<std::int64_t>() > b[key].get<std::int64_t>();
    return false;
  });
  return json_reply({{"version", parts_.board->version()}, {"units", cards}});
}

Reply Api::unit(const std::vector<std::string>& path, const Query& query) const {
  const UnitStore* store = parts_.board->find(path[3]);
  if (store == nullptr) return error_reply(404, "there is no unit '" + printable(path[3]) + "'");
  if (path.size() == 4) return json_reply(unit_json(*store));
  if (path.size() == 5 && path[4] == "alarms")
    return json_reply({{"unit", path[3]}, {"alarms", alarms_json(*store)}});
  if (path.size() == 5 && path[4] == "diagnosis")
    return json_reply(diagnosis_json(*store, parts_.reports));
  if (path.size() == 7 && path[4] == "cvs") {
    const std::vector<std::string> cvs = store->config().cv_tags();
    const auto found = std::find(cvs.begin(), cvs.end(), path[5]);
    if (found == cvs.end()) return error_reply(404, "there is no CV '" + printable(path[5]) + "'");
    return cv(*store, static_cast<int>(found - cvs.begin()), path[6], query);
  }
  return error_reply(404, "there is nothing of this name");
}

Reply Api::cv(const UnitStore& store, int cv, const std::string& what, const Query& query) const {
  if (what == "correlations") return json_reply(correlations_json(store, cv));
  if (what != "series") return error_reply(404, "there is nothing of this name");
  bool bad = false;
  SeriesQuery series;
  series.from_s = number_of<double>(query, "from", bad);
  series.until_s = number_of<double>(query, "until", bad);
  series.span_s = number_of<double>(query, "span", bad);
  series.points = number_of<int>(query, "points", bad).value_or(SeriesQuery::kUsualPoints);
  if (bad)
    return error_reply(400,
                       "from and until are seconds since 1970, span is seconds, points "
                       "is a number");
  if (series.span_s.value_or(1.0) <= 0.0) return error_reply(400, "span is to be more than 0 s");
  if (series.from_s && series.until_s && *series.from_s > *series.until_s)
    return error_reply(400, "from is to be before until");
  if (!is_within(series.points, SeriesQuery::kFewestPoints, SeriesQuery::kMostPoints))
    return error_reply(400, "points is to be from 10 to 2000");
  return json_reply(series_json(store, cv, series));
}

Reply Api::journal(const Query& query) const {
  bool bad = false;
  EventQuery events;
  events.since_ns = moment_of(query, "since", bad);
  events.until_ns = moment_of(query, "until", bad);
  events.unit = text_of(query, "unit");
  events.mv = text_of(query, "mv");
  events.cv = text_of(query, "cv");
  if (bad) return error_reply(400, "since and until are seconds since 1970");
  if (events.since_ns && events.until_ns && *events.since_ns > *events.until_ns)
    return error_reply(400, "since is to be before until");
  const int most = number_of<int>(query, "most", bad).value_or(static_cast<int>(events.most));
  if (bad || !is_within(most, 1, kMostEvents))
    return error_reply(400, "most is to be a whole number from 1 to 5000");
  events.most = static_cast<std::size_t>(most);
  const EventSource& source = parts_.events != nullptr ? *parts_.events : parts_.board->events();
  return json_reply({{"events", source.query(events)}});
}

Reply Api::system() const {
  Json json = system_json(*parts_.board, parts_.version, started_ns_);
  json["commands"] = parts_.guard.takes_commands();
  if (parts_.server) json["server"] = parts_.server();
  return json_reply(json);
}

/// Ready once each unit has been seen: from then on what is said is of the units themselves.
Reply Api::ready() const {
  const auto& units = parts_.board->units();
  const bool ready = std::all_of(units.begin(), units.end(), [](const auto& unit) {
    return unit.second->store.snapshot()->id > 0;
  });
  return json_reply({{"status", ready ? "ready" : "starting"}}, ready ? 200 : 503);
}

Reply Api::metrics() const {
  Reply reply;
  reply.type = kMetricsType;
  reply.body = metrics_text(*parts_.board, parts_.version, started_ns_);
  return reply;
}

Reply Api::report(const std::vector<std::string>& path) const {
  if (path.size() != 4 || parts_.board->find(path[1]) == nullptr)
    return error_reply(404, "there is no such report");
  std::optional<std::string> text = parts_.reports.read(path[1], path[2], path[3]);
  if (!text) return error_reply(404, "there is no such report");
  Reply reply;
  reply.body = std::move(*text);
  if (path[3] == "report.html") {
    reply.type = "text/html; charset=utf-8";
    // Its script is its own and inline. It runs as nobody: it sees neither our page nor the API.
    reply.headers["Content-Security-Policy"] =
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
        "frame-ancestors 'self'; sandbox allow-scripts";
  }
  return reply;
}

Reply Api::command(const Request& request) const {
  auto parsed = parse_command(request.body);
  auto* command = std::get_if<AlarmCommand>(&parsed);
  if (command != nullptr) command->host = request.peer;
  const auto refuse = [&](int status, const std::string& why) {
    if (parts_.refused && command != nullptr && parts_.board->find(command->unit) != nullptr)
      parts_.refused(*command, why);
    return error_reply(status, why);
  };
  if (!parts_.guard.takes_commands())
    return refuse(403,
                  "this monitor takes no commands over HTTP: it was started without "
                  "--token-file");
  if (!parts_.guard.is_authorized(header(request, "authorization"))) {
    Reply reply = refuse(401, "the token is missing or wrong");
    reply.headers["WWW-Authenticate"] = "Bearer";
    return reply;
  }
  // What a form of another page can send without asking is none.
  if (header(request, "content-type").rfind("application/json", 0) != 0)
    return error_reply(415, "the body is to be application/json");
  if (command == nullptr) return error_reply(400, std::get<std::string>(parsed));
  if (parts_.board->find(command->unit) == nullptr)
    return error_reply(404, "there is no unit '" + command->unit + "'");
  if (!parts_.command) return error_reply(501, "commands are not carried out by this monitor");
  const CommandReply done = parts_.command(*command);
  return json_reply({{"accepted", done.accepted}, {"text", done.text}}, done.accepted ? 200 : 409);
}

}  // namespace mpm::http
