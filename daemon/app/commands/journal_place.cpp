#include "daemon/app/commands/journal_place.hpp"

#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include "config/time_text.hpp"
#include "daemon/app/commands/quantity.hpp"

namespace mpm::app {
namespace {

// Of the package's service.
constexpr const char* kUsualFolder = "/var/lib/mpm";

std::string usual_file() {
  const char* folder = std::getenv("STATE_DIRECTORY");
  return std::string(folder == nullptr ? kUsualFolder : folder) + "/alarms.sqlite";
}

/// ISO 8601 with its zone, or so long ago, as 8h.
std::optional<std::int64_t> moment_of(const std::string& option, std::string text) {
  if (text.empty()) return std::nullopt;
  const std::string as_typed = text;
  const bool dated = text.find('-') != std::string::npos || text.find('T') != std::string::npos;
  if (dated) {
    if (const std::optional<std::int64_t> time = config::parse_time(text)) return time;
  } else if (positive_time_value()(text).empty()) {
    constexpr double kNanoseconds = 1e9;
    const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::system_clock::now().time_since_epoch());
    return now.count() - static_cast<std::int64_t>(kNanoseconds * std::stod(text));
  }
  throw std::runtime_error(option + ": '" + as_typed +
                           "' is neither a time with its zone, as 2026-03-01T06:00Z, nor so long "
                           "ago, as 8h or 7d");
}

}  // namespace

void add_journal_place(CLI::App& command, JournalPlace& place) {
  place.file = usual_file();
  command.add_option("--journal", place.file, "the SQLite file that mpmd keeps")
      ->capture_default_str();
  command.add_option("--since", place.since, "a time, as 2026-03-01T06:00Z, or so long ago, as 8h");
  command.add_option("--until", place.until, "the same");
  command.add_option("--unit", place.unit, "of this unit alone");
  command.add_option("--mv", place.mv, "of this manipulated variable alone");
  command.add_option("--cv", place.cv, "of this controlled variable alone");
}

history::AlarmQuery query_of(const JournalPlace& place) {
  history::AlarmQuery query;
  query.since_ns = moment_of("--since", place.since);
  query.until_ns = moment_of("--until", place.until);
  query.unit = place.unit;
  query.mv = place.mv;
  query.cv = place.cv;
  return query;
}

}  // namespace mpm::app
