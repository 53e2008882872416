#include "daemon/bus/watch/viewer.hpp"

#include <cstdio>
#include <type_traits>
#include <variant>

#include "daemon/bus/watch/printable_output.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::bus {
namespace {

constexpr std::chrono::milliseconds kRedraw{250};
constexpr std::chrono::seconds kRatePeriod{1};

void print_line(const std::string& line) {
  if (line.empty()) return;
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fputc('\n', stdout);
}

// Layouts and an alarm's state, which follows its change, are no lines.
std::string json_line(const auto& record) { return report::json_text(report::json_of(record)); }
std::string json_line(const idl::LayoutRecord&) { return ""; }
std::string json_line(const AlarmStateRecord&) { return ""; }
std::string json_line(const idl::MonitorGone& gone) {
  return report::json_text(nlohmann::ordered_json{{"record", "monitor_gone"}, {"unit", gone.unit}});
}

// Clears what the new picture does not cover, and only that: no flicker.
std::string in_place(const std::string& picture) {
  std::string text = "\x1b[H";
  for (const char c : picture) {
    if (c == '\n') text += "\x1b[K";
    text += c;
  }
  return text + "\x1b[J";
}

}  // namespace

Viewer::Viewer(ViewMode mode, const RenderOptions& options, std::string unit)
    : mode_(mode), options_(options), board_(std::move(unit)), last_rate_(Clock::now()) {
  if (mode_ == ViewMode::kTable) std::fputs("\x1b[2J", stdout);
}

void Viewer::show(const idl::Output& output, const std::string& writer, Clock::time_point now) {
  if (mode_ == ViewMode::kJson) {
    print_json(output);
    board_.update(output);
    return;
  }
  const idl::Output shown = printable_output(output);
  const bool listens = board_.listens_to(shown, writer, now);
  if (mode_ == ViewMode::kLines && listens) print_change(shown);
  board_.update(shown, writer);
}

void Viewer::print_json(const idl::Output& output) {
  const auto print = [this](const auto& record) {
    constexpr bool kAlarm = std::is_base_of_v<AlarmRecord, std::decay_t<decltype(record)>>;
    if (board_.wanted(record.unit) && (kAlarm || !options_.alarms_only))
      print_line(json_line(record));
  };
  std::visit(print, output);
}

void Viewer::print_change(const idl::Output& output) {
  const auto board_of = [this](const std::string& unit) {
    const auto it = board_.units().find(unit);
    return it == board_.units().end() ? nullptr : &it->second;
  };
  const auto known_channel = [&](const auto& record) -> const ChannelRecord* {
    const UnitBoard* board = board_of(record.unit);
    if (board == nullptr) return nullptr;
    const auto it = board->channels.find({record.mv, record.cv});
    return it == board->channels.end() ? nullptr : &it->second;
  };
  if (const auto* alarm = std::get_if<AlarmRecord>(&output)) {
    if (board_.wanted(alarm->unit)) print_line(change_line(*alarm, known_channel(*alarm)));
    return;
  }
  if (options_.alarms_only) return;
  if (const auto* channel = std::get_if<ChannelRecord>(&output)) {
    if (!board_.wanted(channel->unit)) return;
    print_line(change_line(known_channel(*channel), *channel));
  } else if (const auto* health = std::get_if<HealthRecord>(&output)) {
    if (!board_.wanted(health->unit)) return;
    const UnitBoard* board = board_of(health->unit);
    print_line(change_line(board == nullptr ? HealthRecord{} : board->health, *health));
  } else if (const auto* gone = std::get_if<idl::MonitorGone>(&output)) {
    const UnitBoard* board = board_of(gone->unit);
    if (board != nullptr && !board->gone) print_line(gone->unit + " monitor gone");
  }
}

void Viewer::tick(Clock::time_point now) {
  if (mode_ == ViewMode::kTable) draw(now);
  std::fflush(stdout);
}

void Viewer::draw(Clock::time_point now) {
  if (now - last_rate_ >= kRatePeriod) {
    board_.take_rate(now - last_rate_);
    board_.note_speakers(now);
    last_rate_ = now;
  }
  if (now - last_drawn_ < kRedraw) return;
  last_drawn_ = now;
  const std::string text = in_place(render(board_, options_));
  std::fwrite(text.data(), 1, text.size(), stdout);
}

bool Viewer::has_reader() const { return std::ferror(stdout) == 0; }

}  // namespace mpm::bus
