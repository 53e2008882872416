#include "daemon/live/role.hpp"

#include <charconv>

namespace mpm::live {
namespace {

// Others answer to the announcement of a new participant at once; only what is lost on the way is
// said again later.
constexpr std::chrono::seconds kListen{2};
// Above every rank.
constexpr int kSpeaks = 1 << 16;
static_assert(kSpeaks > Role::kGreatestRank);

int number_of(const std::string& text) {
  int number = 0;
  (void)std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

Role::Role(const idl::Participant& participant, const std::string& unit, const idl::Process& self,
           int rank)
    : writer_(participant, idl::kRoleTopic, idl::role_writer_qos(unit, rank)),
      self_(writer_.handle()),
      unit_(unit),
      host_(self.host),
      process_(number_of(self.pid)),
      rank_(rank) {}

void Role::write() const {
  mpm_Role sample{};
  // Cyclone's samples are not const; it does not change what it writes.
  sample.unit = const_cast<char*>(unit_.c_str());
  sample.host = const_cast<char*>(host_.c_str());
  sample.process = process_;
  sample.active = active_;
  sample.since_ns = since_ns_;
  (void)writer_.write(sample);  // said again at once
}

void Role::say(Clock::time_point now, std::int64_t wall_ns) {
  if (!listens_until_) {
    listens_until_ = now + kListen;
    since_ns_ = wall_ns;
  }
  write();
}

void Role::hear(const mpm_Role& sample, std::uint64_t writer) {
  heard_ = writer;
  if (writer == self_) return;
  speaker_ = idl::name_of(
      {sample.host == nullptr ? "" : sample.host, "mpmd", std::to_string(sample.process)});
}

bool Role::settle(Clock::time_point now, std::int64_t wall_ns) {
  const bool speaks = heard_ == self_ && now >= listens_until_.value_or(now + kListen);
  if (speaks == active_) return false;
  active_ = speaks;
  since_ns_ = wall_ns;
  if (!idl::set_strength(writer_.get(), active_ ? kSpeaks + rank_ : rank_))
    throw idl::Error("DDS: the strength of a writer of mpm/role could not be set");
  write();
  return true;
}

}  // namespace mpm::live
