#include "daemon/live/neighbours.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "config/suggest.hpp"
#include "idl/topics.hpp"

namespace mpm::live {
namespace {

// Another monitor says something each second.
constexpr std::chrono::seconds kGone{10};
// A monitor that starts is found within a second or so.
constexpr std::chrono::seconds kStandbyKnown{10};
constexpr std::size_t kMostNames = 3;

}  // namespace

void Neighbours::share(std::unique_ptr<Role> role, Clock::time_point now) {
  role_ = std::move(role);
  role_begins_ = now;
}

bool Neighbours::settle(Clock::time_point now, std::int64_t wall_ns) {
  if (!role_->settle(now, wall_ns)) return false;
  role_begins_ = now;
  others_.clear();
  return true;
}

void Neighbours::hear(std::uint64_t writer, std::string name, Clock::time_point now) {
  if (stands_by()) return;
  others_[writer] = {std::move(name), now};
  std::erase_if(others_, [&](const auto& other) { return !speaks(other.second, now); });
}

// Of two monitors a reader keeps the last word, and one that starts clears all alarms. While
// another one speaks an alarm of either stands; when it has left, what this one says holds.
std::optional<bool> Neighbours::to_say_again(Clock::time_point now) {
  const bool before = std::exchange(spoke_, any_speaks(now));
  if (spoke_) return false;
  return before ? std::optional(true) : std::nullopt;
}

bool Neighbours::speaks(const Other& other, Clock::time_point now) const {
  return now - other.heard < kGone;
}

bool Neighbours::any_speaks(Clock::time_point now) const {
  return std::any_of(others_.begin(), others_.end(),
                     [&](const auto& other) { return speaks(other.second, now); });
}

std::vector<bus::Trouble> Neighbours::troubles(const bus::Surroundings& around,
                                               Clock::time_point now) const {
  using bus::Severity;
  std::vector<bus::Trouble> found;
  if (any_speaks(now))
    found.push_back(
        {"other monitor", Severity::kMaintenanceRequired, names_text(around.self, now)});
  if (role_ && role_->active() && now - role_begins_ > kStandbyKnown && !has_standby(around))
    found.push_back(
        {"no standby", Severity::kMaintenanceRequired, "no other monitor stands by for this unit"});
  return found;
}

bool Neighbours::has_standby(const bus::Surroundings& around) const {
  return std::any_of(around.endpoints.begin(), around.endpoints.end(), [this](const auto& other) {
    return other.writer && other.topic == idl::kRoleTopic && other.user_data == unit_;
  });
}

// In the same words from each of them: a reader gets what they say in turn.
std::string Neighbours::names_text(const std::string& self, Clock::time_point now) const {
  std::vector<std::string> names = {self};
  for (const auto& [writer, other] : others_)
    if (speaks(other, now)) names.push_back(other.name);
  std::sort(names.begin(), names.end());
  return std::to_string(names.size()) +
         " monitors watch this unit: " + config::join(names, kMostNames) +
         "; readers see them in turn";
}

}  // namespace mpm::live
