#include "daemon/live/domain.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/text/printable.hpp"

namespace mpm::live {
namespace {

constexpr int kBatch = 64;  // samples
constexpr std::chrono::seconds kLookPeriod{1};
constexpr std::chrono::seconds kMemoryOfStrangers{10};
constexpr std::size_t kMostStrangers = 8;
constexpr std::chrono::hours kStrangerIsNews{1};  // once it has been away for so long
// No control room gives more; whoever floods the bus fills no journal.
constexpr int kMostCommands = 50;
constexpr std::chrono::seconds kCommandPeriod{10};

}  // namespace

Domain::Domain(const idl::DomainOptions& options, const std::vector<std::string>& units,
               CommandGate& gate, std::optional<int> rank)
    : participant_(options),
      discovery_(participant_),
      sampled_(units),
      spoken_of_(units),
      commanded_(units),
      samples_(participant_, &sampled_),
      layouts_(participant_, idl::kLayoutTopic, idl::layout_qos(), kBatch, &spoken_of_),
      other_monitors_(participant_, idl::kHealthTopic, idl::neighbour_health_qos(), kBatch,
                      &spoken_of_),
      commands_(participant_, idl::kCommandTopic, idl::command_qos(), kBatch, &commanded_),
      replies_(participant_),
      outputs_(participant_),
      gate_(gate),
      unknown_log_(kStrangerIsNews),
      command_limit_(kMostCommands, kCommandPeriod) {
  if (rank) others_.emplace(participant_, &spoken_of_, *rank);
  around_.place = bus::place_text(options);
  around_.self = idl::name_of(discovery_.own());
}

UnitPipeline& Domain::add_unit(const config::UnitConfig& unit, SampleJournal* samples,
                               Clock::time_point now) {
  auto pipeline = std::make_unique<UnitPipeline>(unit, outputs_, samples, now);
  if (others_)
    pipeline->share(
        std::make_unique<Role>(participant_, unit.unit, discovery_.own(), others_->rank), now);
  return *(units_[unit.unit] = std::move(pipeline));
}

void Domain::attach_to(idl::WaitSet& wait_set) const {
  samples_.attach_to(wait_set);
  wait_set.attach(layouts_.readable());
  wait_set.attach(commands_.readable());
}

void Domain::poll(Clock::time_point now) {
  layouts_.take_with_info([this](const mpm_Layout& layout, const idl::SampleInfo& info) {
    if (layout.unit == nullptr || layout.kind == nullptr) return;
    const auto it = units_.find(std::string_view(layout.unit));
    if (it == units_.end()) return;
    if (info.valid)
      it->second->hear(layout, info.writer);
    else
      it->second->forget_layout(layout.kind, info.writer);
  });
  samples_.take([&](const idl::SampleView& sample) {
    if (others_)
      settle_roles(Clock::now());  // judging all that has come takes longer than a role bears
    if (const auto it = units_.find(sample.unit); it != units_.end()) it->second->push(sample, now);
  });
  take_commands(now);
}

Domain::Others::Others(const idl::Participant& participant, idl::UnitChoice* units, int own_rank)
    : rank(own_rank),
      roles(participant, idl::kRoleTopic, idl::role_reader_qos(), kBatch, units),
      alarms(participant, idl::kAlarmTopic, idl::others_alarm_qos(), kBatch, units),
      events(participant, idl::kAlarmEventTopic, idl::others_alarm_event_qos(), kBatch, units),
      controllers(participant, idl::kControllerAlarmTopic, idl::others_alarm_qos(), kBatch, units) {
}

void Domain::settle_roles(Clock::time_point now) {
  if (!others_ || now < next_roles_) return;
  next_roles_ = now + Role::kPeriod / 2;
  for (const auto& [name, unit] : units_) unit->say_role(now);
  others_->roles.take_with_info([&](const mpm_Role& role, const idl::SampleInfo& info) {
    if (!info.valid || role.unit == nullptr) return;
    if (const auto it = units_.find(std::string_view(role.unit)); it != units_.end())
      it->second->hear_role(role, info.writer);
  });
  take_told();
  for (const auto& [name, unit] : units_) unit->settle_role(now);
}

// All that there is: whoever takes over must not tell it again.
void Domain::take_told() {
  const auto take_all = [this]<class Record>(auto& reader, const Record*) {
    const auto hear = [this](const auto& sample) {
      if (sample.unit == nullptr) return;
      if (const auto it = units_.find(std::string_view(sample.unit)); it != units_.end())
        it->second->hear_told(idl::record_of<Record>(sample));
    };
    while (reader.take(hear) == kBatch) {
    }
  };
  take_all(others_->events, static_cast<const AlarmRecord*>(nullptr));
  take_all(others_->alarms, static_cast<const AlarmStateRecord*>(nullptr));
  take_all(others_->controllers, static_cast<const ControllerAlarmRecord*>(nullptr));
}

void Domain::take_commands(Clock::time_point now) {
  commands_.take([&](const mpm_Command& sample) {
    if (sample.unit == nullptr) return;
    const auto it = units_.find(std::string_view(sample.unit));
    if (it == units_.end() || it->second->stands_by()) return;  // who speaks answers
    if (!command_limit_.admit(now)) {
      if (command_log_limit_.admit(now))
        spdlog::warn("more than {} commands in {} s: the rest is ignored", kMostCommands,
                     kCommandPeriod.count());
      return;
    }
    const auto record = idl::record_of<CommandRecord>(sample);
    const std::int64_t wall_ns = UnitPipeline::wall_ns();
    const CommandReply reply = it->second->obey(record, gate_.admit(record, wall_ns));
    CommandReplyRecord answer;
    answer.unit = record.unit;
    answer.id = printable(record.id);
    answer.accepted = reply.accepted;
    answer.text = reply.text;
    answer.time_ns = wall_ns;
    if (!replies_.write(answer) && command_log_limit_.admit(now))
      spdlog::warn("{}: a command could not be answered", record.unit);
  });
}

void Domain::report_unknown(Clock::time_point now) {
  const idl::UnitChoice::Refused refused = sampled_.refused();
  unknown_unit_ += refused.samples;
  for (const auto& [unit, writer] : refused.units)
    if (around_.strangers.size() < kMostStrangers) around_.strangers.insert_or_assign(unit, writer);
  std::vector<bus::Trouble> names;
  for (const auto& [unit, writer] : around_.strangers)
    names.push_back({"unknown unit", bus::Severity::kMaintenanceRequired,
                     "samples of unit '" + unit + "', which no unit file describes; ignored",
                     unit});
  for (const TroubleLog::Line& line : unknown_log_.update(names, now, 0)) spdlog::warn(line.text);
}

void Domain::hear_other_monitors(Clock::time_point now) {
  other_monitors_.take_with_info([&](const mpm_Health& health, const idl::SampleInfo& info) {
    if (health.unit == nullptr) return;
    const auto it = units_.find(std::string_view(health.unit));
    if (it == units_.end()) return;
    if (!info.valid) return it->second->hear_no_other_monitor();
    if (bus::find_writer(around_, info.writer) == nullptr) look_around(now);
    it->second->hear_other_monitor(info.writer, bus::writer_name(around_, info.writer), now);
  });
}

void Domain::forget_strangers(Clock::time_point now) {
  if (now < next_forgetting_) return;
  next_forgetting_ = now + kMemoryOfStrangers;
  around_.strangers.clear();
}

// Reading all endpoints may take a millisecond.
void Domain::look_around(Clock::time_point now) {
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  around_.endpoints = discovery_.endpoints();
}

void Domain::tick(Clock::time_point now) {
  report_unknown(now);
  hear_other_monitors(now);
  if (std::any_of(units_.begin(), units_.end(),
                  [&](const auto& unit) { return unit.second->wants_endpoints(now); }))
    look_around(now);
  for (const auto& [name, unit] : units_) unit->tick(now, unknown_unit_, around_);
  forget_strangers(now);
}

// One state at a time: a role is to be said between two of them.
bool Domain::rest(const std::function<bool()>& disturbed) {
  return std::any_of(units_.begin(), units_.end(),
                     [&](const auto& unit) { return unit.second->rest(disturbed); });
}

}  // namespace mpm::live
