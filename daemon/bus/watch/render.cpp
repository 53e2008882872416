#include "daemon/bus/watch/render.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <vector>

namespace mpm::bus {
namespace {

constexpr const char* kReset = "\x1b[0m";
constexpr const char* kGrey = "\x1b[90m";
constexpr const char* kGreen = "\x1b[32m";
constexpr const char* kRed = "\x1b[1;31m";
constexpr const char* kBold = "\x1b[1m";

struct Painter {
  bool color;
  [[nodiscard]] std::string operator()(const char* code, const std::string& text) const {
    return color ? code + text + kReset : text;
  }
};

std::string utc(std::int64_t time_ns) {
  if (time_ns == 0) return "-";  // before the first sample
  const std::time_t seconds = time_ns / 1'000'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

const char* color_of(const std::string& verdict) {
  if (verdict == "match") return kGreen;
  return verdict == "mismatch" ? kRed : kGrey;
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() >= width ? text : text + std::string(width - text.size(), ' ');
}

const report::ChannelRecord* find(const UnitBoard& board, const std::string& input,
                                  const std::string& cv) {
  const auto it = board.channels.find({input, cv});
  return it == board.channels.end() ? nullptr : &it->second;
}

std::string shout(const report::ChannelRecord& channel) {
  std::string word = channel.verdict.empty() ? "-" : channel.verdict;
  return channel.alarm_active ? word + " !" : word;
}

std::size_t column_width(const UnitBoard& board, const std::string& input) {
  std::size_t width = input.size();
  for (const std::string& cv : board.cvs)
    if (const report::ChannelRecord* channel = find(board, input, cv))
      width = std::max({width, shout(*channel).size(), channel->reason.size()});
  return width + 2;
}

std::string matrix(const UnitBoard& board, const Painter& paint) {
  std::vector<std::size_t> widths;
  for (const std::string& input : board.inputs) widths.push_back(column_width(board, input));
  std::size_t first = 2;
  for (const std::string& cv : board.cvs) first = std::max(first, cv.size() + 2);

  std::string text = "  " + std::string(first, ' ');
  for (std::size_t i = 0; i < widths.size(); ++i)
    text += paint(kBold, padded(board.inputs[i], widths[i]));
  text += '\n';
  for (const std::string& cv : board.cvs) {
    std::string verdicts = "  " + paint(kBold, padded(cv, first));
    std::string reasons = "  " + std::string(first, ' ');
    bool any_reason = false;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const report::ChannelRecord* channel = find(board, board.inputs[i], cv);
      verdicts += channel == nullptr
                      ? padded("", widths[i])
                      : paint(color_of(channel->verdict), padded(shout(*channel), widths[i]));
      reasons += padded(channel == nullptr ? "" : channel->reason, widths[i]);
      any_reason = any_reason || (channel != nullptr && !channel->reason.empty());
    }
    text += verdicts + '\n';
    if (any_reason) text += paint(kGrey, reasons) + '\n';
  }
  return text;
}

std::string head(const std::string& name, const UnitBoard& board, const Painter& paint) {
  const report::HealthRecord& health = board.health;
  std::string text = paint(kBold, name) +
                     fmt::format("  {} samples, {:.1f}/s", board.samples, board.samples_per_s);
  if (health.source_time_ns != 0) text += ", data of " + utc(health.source_time_ns);
  text += '\n';
  if (board.gone)
    text += "  " + paint(kRed, "monitor gone: what follows is its last word") + '\n';
  else if (!health.state.empty())
    text += "  health: " + health.state +
            (health.detail.empty() ? "" : " (" + health.detail + ")") + '\n';
  return text;
}

std::string alarm_text(const report::AlarmRecord& alarm) {
  return fmt::format("{} -> {}  since {}  p {:.1e}  gain error {:.3g}", alarm.mv, alarm.cv,
                     utc(alarm.source_time_ns), alarm.p_value, alarm.effect_size);
}

/// "gain_ratio 0.7 (0.68 to 0.72)", all of them.
std::string numbers_text(const report::NamedCause& named) {
  std::string text;
  for (const report::CauseParameter& parameter : named.parameters)
    text += fmt::format("{}{} {:.3g} ({:.3g} to {:.3g})", text.empty() ? "" : ", ", parameter.name,
                        parameter.value, parameter.low, parameter.high);
  return text;
}

std::string cause_text(const report::NamedCause& named) {
  if (named.cause.empty()) return "cause: not named";
  return fmt::format("cause: {}, {:.0f} % sure  {}", named.cause, 100.0 * named.confidence,
                     numbers_text(named));
}

}  // namespace

std::string render(const Board& board, const RenderOptions& options) {
  const Painter paint{options.color};
  std::string text;
  for (const auto& [name, unit] : board.units()) {
    if (unit.channels.empty() && unit.health.unit.empty()) continue;  // nobody watches it
    text += head(name, unit, paint);
    if (!options.alarms_only && !unit.channels.empty()) text += matrix(unit, paint);
    text += unit.alarms.empty() ? "  no active alarms\n" : "  active alarms:\n";
    for (const auto& [channel, alarm] : unit.alarms) {
      text += "  " + paint(kRed, "! " + alarm_text(alarm)) + '\n';
      if (!alarm.named.text.empty()) text += "      " + cause_text(alarm.named) + '\n';
    }
    text += '\n';
  }
  return text.empty() ? "waiting for a monitor ...\n" : text;
}

std::string change_line(const report::ChannelRecord* before, const report::ChannelRecord& after) {
  const std::string old = before == nullptr ? "" : before->verdict;
  if (old == after.verdict && (before == nullptr || before->reason == after.reason)) return "";
  std::string line = fmt::format("{} {} {} -> {}: {}", utc(after.source_time_ns), after.unit,
                                 after.mv, after.cv, after.verdict);
  if (!after.reason.empty()) line += " (" + after.reason + ")";
  if (after.reason.empty()) line += fmt::format(" (p {:.1e})", after.p_value);
  return line;
}

std::string change_line(const report::AlarmRecord& change) {
  if (change.to == "diagnosed")
    return fmt::format("{} {} {} -> {}: {}. {}", utc(change.source_time_ns), change.unit, change.mv,
                       change.cv, cause_text(change.named), change.named.text);
  return fmt::format("{} {} {} -> {}: alarm {} (p {:.1e}, gain error {:.3g})",
                     utc(change.source_time_ns), change.unit, change.mv, change.cv, change.to,
                     change.p_value, change.effect_size);
}

std::string change_line(const report::HealthRecord& before, const report::HealthRecord& after) {
  if (before.state == after.state) return "";
  return fmt::format("{} {} health: {}{}", utc(after.source_time_ns), after.unit, after.state,
                     after.detail.empty() ? "" : " (" + after.detail + ")");
}

}  // namespace mpm::bus
