#include "daemon/bus/watch/render.hpp"

#include <spdlog/fmt/fmt.h>

#include <vector>

#include "core/record/reason_text.hpp"
#include "core/text/number_text.hpp"
#include "daemon/bus/trouble.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/report/channel_text.hpp"
#include "daemon/report/matrix_text.hpp"

namespace mpm::bus {
namespace {

using report::Tint;

std::string utc(std::int64_t time_ns) {
  if (time_ns == 0) return "-";  // before the first sample
  return files::formatted_utc(time_ns / 1'000'000'000, "%Y-%m-%dT%H:%M:%SZ");
}

Tint tint_of(Verdict verdict) {
  if (verdict == Verdict::kMatch) return Tint::kGreen;
  return verdict == Verdict::kMismatch ? Tint::kRed : Tint::kGrey;
}

const ChannelRecord* find(const UnitBoard& board, const std::string& input, const std::string& cv) {
  const auto it = board.channels.find({input, cv});
  return it == board.channels.end() ? nullptr : &it->second;
}

std::string reason_of(const ChannelRecord& channel) {
  return reason_text(channel.reason, channel.confounder);
}

std::string shout(const ChannelRecord& channel) {
  std::string word(to_string(channel.verdict));
  return channel.alarm == AlarmState::kActive ? word + " !" : word;
}

// The monitor says nothing of channels while no data come.
bool outdated(const UnitBoard& board) {
  return board.gone || board.health.state == to_string(Severity::kFailure);
}

// Under the verdicts of a CV a row with the reasons of those that are undetermined.
std::string matrix(const UnitBoard& board, const report::Layout& layout) {
  std::vector<report::MatrixRow> rows;
  for (const std::string& cv : board.cvs) {
    report::MatrixRow verdicts{cv, {}}, reasons;
    bool any_reason = false;
    for (const std::string& input : board.inputs) {
      const ChannelRecord* channel = find(board, input, cv);
      const bool known = channel != nullptr;
      verdicts.cells.push_back({known ? shout(*channel) : "", !known ? Tint::kPlain
                                                              : outdated(board)
                                                                  ? Tint::kGrey
                                                                  : tint_of(channel->verdict)});
      reasons.cells.push_back({known ? reason_of(*channel) : "", Tint::kGrey});
      any_reason = any_reason || !reasons.cells.back().text.empty();
    }
    rows.push_back(std::move(verdicts));
    if (any_reason) rows.push_back(std::move(reasons));
  }
  return matrix_text(board.inputs, rows, layout);
}

std::string head(const std::string& name, const UnitBoard& board, const report::Layout& layout) {
  const HealthRecord& health = board.health;
  std::string text =
      layout.paint(Tint::kBold, name) +
      fmt::format("  {}, {:.1f}/s", counted(board.samples, "sample"), board.samples_per_s);
  if (health.source_time_ns != 0) text += ", data of " + utc(health.source_time_ns);
  text += '\n';
  if (board.gone)
    text += "  " + layout.paint(Tint::kRed, "monitor gone: what follows is its last word") + '\n';
  else if (!health.state.empty())
    text += "  health: " + health.state +
            (health.detail.empty() ? "" : " (" + health.detail + ")") + '\n';
  if (!board.gone && outdated(board) && !board.channels.empty())
    text += "  " +
            layout.paint(Tint::kRed,
                         "no verdicts now; those below are of " + utc(health.source_time_ns)) +
            '\n';
  if (!board.note.empty()) text += "  " + layout.paint(Tint::kRed, board.note) + '\n';
  return text;
}

std::string alarm_text(const UnitBoard& board, const AlarmRecord& alarm) {
  return fmt::format("{} -> {}  since {}  {}  p {:.1e}", alarm.mv, alarm.cv,
                     utc(alarm.source_time_ns),
                     report::error_text(alarm, find(board, alarm.mv, alarm.cv)), alarm.p_value);
}

/// "gain_ratio 0.7 (0.68 to 0.72)", all of them.
std::string numbers_text(const NamedCause& named) {
  std::string text;
  for (const CauseParameter& parameter : named.parameters)
    text += fmt::format("{}{} {:.3g} ({:.3g} to {:.3g})", text.empty() ? "" : ", ", parameter.name,
                        parameter.value, parameter.low, parameter.high);
  return text;
}

std::string cause_text(const NamedCause& named) {
  if (!named.cause) return "cause: not named";
  return fmt::format("cause: {}, {} sure  {}", *named.cause, sure_text(named.confidence),
                     numbers_text(named));
}

}  // namespace

std::string render(const Board& board, const RenderOptions& options) {
  std::string text;
  for (const auto& [name, unit] : board.units()) {
    if (unit.channels.empty() && unit.health.unit.empty()) continue;  // nobody watches it
    text += head(name, unit, options.layout);
    if (!options.alarms_only && !unit.channels.empty()) text += matrix(unit, options.layout);
    text += unit.alarms.empty() ? "  no active alarms\n" : "  active alarms:\n";
    for (const auto& [channel, alarm] : unit.alarms) {
      text += "  " + options.layout.paint(Tint::kRed, "! " + alarm_text(unit, alarm)) + '\n';
      if (!alarm.named.text.empty()) text += "      " + cause_text(alarm.named) + '\n';
    }
    text += '\n';
  }
  return text.empty() ? "waiting for a monitor ...\n" : text;
}

std::string change_line(const ChannelRecord* before, const ChannelRecord& after) {
  const std::string reason = reason_of(after);
  if (before != nullptr && before->verdict == after.verdict && reason_of(*before) == reason)
    return "";
  return fmt::format("{} {} {} -> {}: {} ({})", utc(after.source_time_ns), after.unit, after.mv,
                     after.cv, to_string(after.verdict),
                     reason.empty() ? fmt::format("p {:.1e}", after.p_value) : reason);
}

std::string change_line(const AlarmRecord& change, const ChannelRecord* channel) {
  if (change.to == AlarmChange::kDiagnosed)
    return fmt::format("{} {} {} -> {}: {}. {}", utc(change.source_time_ns), change.unit, change.mv,
                       change.cv, cause_text(change.named), change.named.text);
  return fmt::format("{} {} {} -> {}: alarm {} ({}, p {:.1e})", utc(change.source_time_ns),
                     change.unit, change.mv, change.cv, to_string(change.to),
                     report::error_text(change, channel), change.p_value);
}

std::string change_line(const HealthRecord& before, const HealthRecord& after) {
  if (before.state == after.state) return "";
  return fmt::format("{} {} health: {}{}", utc(after.source_time_ns), after.unit, after.state,
                     after.detail.empty() ? "" : " (" + after.detail + ")");
}

}  // namespace mpm::bus
