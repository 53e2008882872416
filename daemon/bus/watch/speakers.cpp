#include "daemon/bus/watch/speakers.hpp"

namespace mpm::bus {
namespace {

// Health comes once a second.
constexpr std::chrono::seconds kSilent{5};

// Anybody may write to a bus.
constexpr std::size_t kMostNames = 16, kMostUnits = 10'000;

}  // namespace

bool Speakers::listens_to(const std::string& unit, const std::string& name, Clock::time_point now) {
  if (units_.size() >= kMostUnits && units_.find(unit) == units_.end()) return true;
  Unit& of = units_[unit];
  std::erase_if(of.heard, [&](const auto& other) { return now - other.second >= kSilent; });
  if (of.heard.size() >= kMostNames && of.heard.find(name) == of.heard.end()) return false;
  of.heard[name] = now;
  if (of.heard.find(of.first) == of.heard.end()) of.first = name;
  return name == of.first;
}

std::string Speakers::first(const std::string& unit) const {
  const auto it = units_.find(unit);
  return it == units_.end() ? "" : it->second.first;
}

void Speakers::leaves(const std::string& unit, const std::string& name) {
  const auto it = units_.find(unit);
  if (it != units_.end()) it->second.heard.erase(name);
}

std::string Speakers::note(const std::string& unit, Clock::time_point now) const {
  const auto it = units_.find(unit);
  if (it == units_.end()) return {};
  const std::string& first = it->second.first;
  std::string others;
  std::size_t count = 1;
  for (const auto& [name, heard] : it->second.heard) {
    if (name == first || now - heard >= kSilent) continue;
    others += ", " + name;
    ++count;
  }
  if (count == 1) return {};
  return (count == 2 ? std::string("two") : std::to_string(count)) +
         " monitors publish for it: " + first + others + "; what follows is of the first";
}

}  // namespace mpm::bus
