#include "daemon/bus/watch/board.hpp"

#include <algorithm>
#include <cctype>

namespace mpm::bus {
namespace {

constexpr std::size_t kMostHidden = 10'000;  // anybody may speak

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::size_t digits_end(const std::string& text, std::size_t from) {
  while (from < text.size() && is_digit(text[from])) ++from;
  return from;
}

// Tags in the order of the layout, those it does not know after them in natural order.
void order(std::vector<std::string>& tags, const std::vector<std::string>& layout) {
  const auto rank = [&](const std::string& tag) {
    return std::find(layout.begin(), layout.end(), tag) - layout.begin();
  };
  std::sort(tags.begin(), tags.end(), [&](const std::string& a, const std::string& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : natural_less(a, b);
  });
}

void order(UnitBoard& board) {
  std::vector<std::string> inputs = board.layout["mv"];
  const std::vector<std::string>& dvs = board.layout["dv"];
  inputs.insert(inputs.end(), dvs.begin(), dvs.end());
  order(board.inputs, inputs);
  order(board.cvs, board.layout["cv"]);
}

const std::string& unit_of(const idl::Output& output) {
  return std::visit([](const auto& record) -> const std::string& { return record.unit; }, output);
}

bool add_once(std::vector<std::string>& tags, const std::string& tag) {
  if (std::find(tags.begin(), tags.end(), tag) != tags.end()) return false;
  tags.push_back(tag);
  return true;
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::size_t i_end = digits_end(a, i), j_end = digits_end(b, j);
      while (i + 1 < i_end && a[i] == '0') ++i;
      while (j + 1 < j_end && b[j] == '0') ++j;
      if (i_end - i != j_end - j) return i_end - i < j_end - j;
      if (const int order = a.compare(i, i_end - i, b, j, j_end - j); order != 0) return order < 0;
      i = i_end;
      j = j_end;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

bool Board::listens_to(const idl::Output& output, const std::string& writer,
                       Clock::time_point now) {
  // A layout is the control system's.
  if (writer.empty() || std::holds_alternative<idl::LayoutRecord>(output)) return true;
  const std::string& unit = unit_of(output);
  if (!wanted(unit)) return false;
  const std::string before = speakers_.first(unit);
  const bool listens = speakers_.listens_to(unit, writer, now);
  if (listens && !before.empty() && before != writer) turn_to(unit, before, writer);
  if (std::holds_alternative<idl::MonitorGone>(output)) speakers_.leaves(unit, writer);
  if (const auto it = units_.find(unit); it != units_.end())
    it->second.note = speakers_.note(unit, now);
  return listens;
}

void Board::turn_to(const std::string& unit, const std::string& before, const std::string& writer) {
  UnitBoard& shown = units_[unit];
  UnitBoard next = std::move(hidden_[{unit, writer}]);
  next.layout = shown.layout;
  order(next);
  hidden_.erase({unit, writer});
  if (hidden_.size() >= kMostHidden) hidden_.clear();
  hidden_[{unit, before}] = std::move(shown);
  shown = std::move(next);
}

void Board::update(const idl::Output& output, const std::string& writer) {
  const bool shown = writer.empty() || std::holds_alternative<idl::LayoutRecord>(output) ||
                     speakers_.first(unit_of(output)) == writer;
  writer_ = shown ? "" : writer;
  std::visit([this](const auto& record) { show(record); }, output);
}

UnitBoard* Board::board_of(const std::string& unit) {
  if (!wanted(unit)) return nullptr;
  return writer_.empty() ? &units_[unit] : &hidden_[{unit, writer_}];
}

void Board::show(const idl::LayoutRecord& layout) {
  // Of a unit that no monitor watches there is nothing to show.
  UnitBoard* board = board_of(layout.unit);
  if (board == nullptr) return;
  board->layout[layout.kind] = layout.tags;
  order(*board);
}

void Board::show(const ChannelRecord& channel) {
  UnitBoard* board = board_of(channel.unit);
  if (board == nullptr) return;
  board->gone = false;
  if (board->samples == 0 || channel.interval != board->last_interval) ++board->samples;
  board->last_interval = channel.interval;
  const bool new_input = add_once(board->inputs, channel.mv);
  const bool new_cv = add_once(board->cvs, channel.cv);
  if (new_input || new_cv) order(*board);
  board->channels[{channel.mv, channel.cv}] = channel;
}

void Board::show(const AlarmStateRecord& alarm) {
  UnitBoard* board = board_of(alarm.unit);
  if (board == nullptr) return;
  if (alarm.to == AlarmChange::kActive)
    board->alarms[{alarm.mv, alarm.cv}] = alarm;
  else
    board->alarms.erase({alarm.mv, alarm.cv});
}

void Board::show(const HealthRecord& health) {
  UnitBoard* board = board_of(health.unit);
  if (board == nullptr) return;
  // It counts from the start of its daemon. What another one found does not stand any more.
  if (board->gone || health.frames < board->health.frames) {
    board->channels.clear();
    board->alarms.clear();
  }
  board->gone = false;
  board->health = health;
}

void Board::show(const idl::MonitorGone& gone) {
  if (units_.find(gone.unit) == units_.end()) return;
  if (UnitBoard* board = board_of(gone.unit)) board->gone = true;
}

void Board::note_speakers(Clock::time_point now) {
  for (auto& [name, unit] : units_) unit.note = speakers_.note(name, now);
}

void Board::take_rate(std::chrono::duration<double> elapsed) {
  for (auto& [name, board] : units_) {
    board.samples_per_s =
        static_cast<double>(board.samples - board.samples_at_rate) / elapsed.count();
    board.samples_at_rate = board.samples;
  }
}

bool Board::any_alarm() const {
  return std::any_of(units_.begin(), units_.end(),
                     [](const auto& unit) { return !unit.second.alarms.empty(); });
}

}  // namespace mpm::bus
