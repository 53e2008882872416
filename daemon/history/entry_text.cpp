#include "daemon/history/entry_text.hpp"

#include <array>
#include <string_view>

#include "core/signal/nanoseconds.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::history {
namespace {

constexpr std::size_t kLongestText = 1000;
constexpr std::string_view kSuppressed = "suppressed";

std::string quoted(std::string text) {
  if (!text.empty() && std::string("=+-@\t\r").find(text.front()) != std::string::npos)
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char letter : text) result += letter == '"' ? "\"\"" : std::string(1, letter);
  return result + "\"";
}

}  // namespace

std::string entry_text(const AlarmEntry& entry) {
  std::string text = files::formatted_utc(entry.written_ns / kSecondNs, "%Y-%m-%d %H:%M:%S UTC  ") +
                     printable(entry.unit) + "  ";
  text += entry.cv.empty() ? "controller" : printable(entry.mv) + " -> " + printable(entry.cv);
  text += "  " + printable(entry.what);
  if (entry.what == kSuppressed && entry.standing.suppressed_by_design && entry.user.empty())
    text += " by design: the controller is off or the data are bad";
  if (!entry.user.empty()) {
    text += " by " + printable(entry.user);
    if (!entry.host.empty()) text += " on " + printable(entry.host);
  }
  if (!entry.comment.empty()) text += ": " + printable(entry.comment, kLongestText);
  if (!entry.message.empty()) text += " (" + printable(entry.message, kLongestText) + ")";
  return text;
}

nlohmann::ordered_json entry_json(const AlarmEntry& entry) {
  const AlarmStanding& standing = entry.standing;
  return {{"written_ns", entry.written_ns},
          {"time_ns", entry.source_time_ns},
          {"unit", entry.unit},
          {"mv", entry.mv},
          {"cv", entry.cv},
          {"what", entry.what},
          {"alarm_state", to_string(standing.word())},
          {"shelving_state", to_string(standing.shelving)},
          {"unshelve_time_ns", standing.unshelve_time_ns},
          {"suppressed", standing.suppressed},
          {"suppressed_by_design", standing.suppressed_by_design},
          {"out_of_service", standing.out_of_service},
          {"notification_class", to_string(entry.notification_class)},
          {"priority", to_string(entry.priority)},
          {"user", entry.user},
          {"host", entry.host},
          {"comment", entry.comment},
          {"message", entry.message}};
}

std::string entry_csv_head() {
  return "written,plant_time,unit,mv,cv,what,alarm_state,class,priority,user,host,comment,message";
}

std::string entry_csv(const AlarmEntry& entry) {
  const std::array cells = {files::utc_text(entry.written_ns),
                            files::utc_text(entry.source_time_ns),
                            entry.unit,
                            entry.mv,
                            entry.cv,
                            entry.what,
                            std::string(to_string(entry.standing.word())),
                            std::string(to_string(entry.notification_class)),
                            std::string(to_string(entry.priority)),
                            entry.user,
                            entry.host,
                            entry.comment,
                            entry.message};
  std::string line;
  for (const std::string& cell : cells) line += (&cell == cells.data() ? "" : ",") + quoted(cell);
  return line;
}

}  // namespace mpm::history
