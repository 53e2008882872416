#include "daemon/bus/watch/viewer.hpp"

#include <cstdio>

namespace mpm::bus {
namespace {

constexpr std::chrono::milliseconds kRedraw{250};
constexpr std::chrono::seconds kRatePeriod{1};

void print_line(const std::string& line) {
  if (line.empty()) return;
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fputc('\n', stdout);
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

void Viewer::show(const Output& output) {
  if (mode_ == ViewMode::kJson) print_json(output);
  if (mode_ == ViewMode::kLines) print_change(output);
  board_.update(output);
}

void Viewer::print_json(const Output& output) {
  if (const auto* channel = std::get_if<report::ChannelRecord>(&output)) {
    if (!options_.alarms_only && board_.wanted(channel->unit)) print_line(to_json(*channel).dump());
  } else if (const auto* alarm = std::get_if<report::AlarmRecord>(&output)) {
    if (board_.wanted(alarm->unit)) print_line(to_json(*alarm).dump());
  } else if (const auto* health = std::get_if<report::HealthRecord>(&output)) {
    if (!options_.alarms_only && board_.wanted(health->unit)) print_line(to_json(*health).dump());
  }
}

void Viewer::print_change(const Output& output) {
  const auto board_of = [this](const std::string& unit) {
    const auto it = board_.units().find(unit);
    return it == board_.units().end() ? nullptr : &it->second;
  };
  if (const auto* alarm = std::get_if<report::AlarmRecord>(&output)) {
    if (board_.wanted(alarm->unit)) print_line(change_line(*alarm));
    return;
  }
  if (options_.alarms_only) return;
  if (const auto* channel = std::get_if<report::ChannelRecord>(&output)) {
    if (!board_.wanted(channel->unit)) return;
    const report::ChannelRecord* before = nullptr;
    if (const UnitBoard* board = board_of(channel->unit))
      if (const auto it = board->channels.find({channel->mv, channel->cv});
          it != board->channels.end())
        before = &it->second;
    print_line(change_line(before, *channel));
  } else if (const auto* health = std::get_if<report::HealthRecord>(&output)) {
    if (!board_.wanted(health->unit)) return;
    const UnitBoard* board = board_of(health->unit);
    print_line(change_line(board == nullptr ? report::HealthRecord{} : board->health, *health));
  } else if (const auto* gone = std::get_if<MonitorGone>(&output)) {
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
    last_rate_ = now;
  }
  if (now - last_drawn_ < kRedraw) return;
  last_drawn_ = now;
  const std::string text = in_place(render(board_, options_));
  std::fwrite(text.data(), 1, text.size(), stdout);
}

bool Viewer::has_reader() const { return std::ferror(stdout) == 0; }

}  // namespace mpm::bus
