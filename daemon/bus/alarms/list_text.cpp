#include "daemon/bus/alarms/list_text.hpp"

#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/report/moment_text.hpp"

namespace mpm::bus {
namespace {

std::string moment(std::int64_t time_ns) {
  return report::is_date(time_ns)
             ? files::formatted_utc(time_ns / kSecondNs, "%Y-%m-%d %H:%M:%S UTC")
             : number_text(static_cast<double>(time_ns) / 1e9, 7) + " s";
}

report::Tint tint(AlarmWord word) {
  switch (word) {
    case AlarmWord::kUnacknowledged:
      return report::Tint::kRed;
    case AlarmWord::kAcknowledged:
    case AlarmWord::kReturned:
      return report::Tint::kBold;
    case AlarmWord::kNormal:
      return report::Tint::kGreen;
    default:
      return report::Tint::kGrey;
  }
}

/// "unacknowledged since ...", and who did what to it.
std::string how(const ControlRoomView& view) {
  std::string word(to_string(view.alarm_state));
  for (char& letter : word)
    if (letter == '_') letter = ' ';
  return word;
}

std::string besides(const ControlRoomView& view, bool active) {
  std::string text;
  if (active && view.active_time_ns != 0) text += " since " + moment(view.active_time_ns);
  if (view.shelving_state != Shelving::kUnshelved)
    text += (view.alarm_state == AlarmWord::kShelved ? " until " : ", shelved until ") +
            moment(view.unshelve_time_ns) +
            (view.shelving_state == Shelving::kOneShot ? " or until it clears" : "");
  if (view.suppressed_by_design) text += ", by design: the controller is off or the data are bad";
  if (!view.message.empty()) text += ": " + printable(view.message, 400);
  if (!view.client_user_id.empty()) {
    text += " [" + printable(view.client_user_id);
    if (!view.comment.empty()) text += ": " + printable(view.comment, 200);
    text += "]";
  }
  return text;
}

std::string line(const std::string& name, const ControlRoomView& view, bool active,
                 std::size_t indent, const report::Layout& layout) {
  const std::string word = how(view);
  std::string text =
      report::wrapped(name + "  " + word + besides(view, active), indent, layout.width);
  const std::size_t at = text.find(word);
  if (at != std::string::npos)
    text.replace(at, word.size(), layout.paint(tint(view.alarm_state), word));
  return text;
}

}  // namespace

std::string alarm_list_text(const AlarmList& list, const std::string& unit, bool all,
                            const report::Layout& layout) {
  std::string text;
  for (const auto& [name, controller] : list.controllers) {
    if (!unit.empty() && name != unit) continue;
    text +=
        line(printable(name), controller.view, controller.state == AlarmState::kActive, 0, layout);
    for (const auto& [key, alarm] : list.channels)
      if (alarm.unit == name && (all || alarm.view.retain))
        text += line(printable(alarm.mv) + " -> " + printable(alarm.cv), alarm.view,
                     alarm.to == AlarmChange::kActive, 2, layout);
  }
  return text;
}

}  // namespace mpm::bus
