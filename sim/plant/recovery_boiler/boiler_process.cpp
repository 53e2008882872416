#include "sim/plant/recovery_boiler/boiler_process.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <variant>

namespace mpm::sim::boiler {
namespace {

constexpr Eigen::Index kAuxCount = 5;

/// A number of the boiler, or of an instrument, that a scenario may set.
struct Quantity {
  const char* name;
  std::variant<double Condition::*, double Faults::*> where;
};
constexpr std::array<Quantity, 7> kQuantities{{
    {"co_oxidation", &Condition::oxidation},
    {"superheating", &Condition::superheating},
    {"dry_solids", &Condition::solids},
    {"char_burning", &Condition::char_burning},
    {"air_leak", &Condition::air_leak},
    {"valve_stiction", &Faults::valve_stiction},
    {"o2_offset", &Faults::o2_offset},
}};

}  // namespace

std::vector<std::string> BoilerProcess::quantities() {
  std::vector<std::string> names;
  names.reserve(kQuantities.size());
  for (const Quantity& quantity : kQuantities) names.emplace_back(quantity.name);
  return names;
}

BoilerProcess::BoilerProcess(const config::UnitConfig& unit,
                             const std::vector<config::ProcessChange>& changes, std::uint64_t seed)
    : seconds_(static_cast<int>(std::lround(unit.sample_time_s))),
      solids_({kSolidsInnovation, std::exp(-unit.sample_time_s / kSolidsTime)},
              RandomStream(seed, StreamPurpose::kProcess, 0)) {
  if (unit.mv.size() != 4 || unit.cv.size() != 4 || !unit.dv.empty())
    throw std::invalid_argument("the recovery boiler has four MVs, four CVs and no DV");
  if (std::abs(unit.sample_time_s - seconds_) > 1e-9 || seconds_ < 1)
    throw std::invalid_argument("the recovery boiler wants a sample_time of whole seconds");
  const std::vector<std::string> names = quantities();
  for (const config::ProcessChange& change : changes) {
    const auto found = std::find(names.begin(), names.end(), change.quantity);
    if (found == names.end()) throw std::invalid_argument("no quantity '" + change.quantity + "'");
    changes_.push_back({static_cast<std::size_t>(found - names.begin()),
                        change.value,
                        {change.from_s, change.until_s, unit.sample_time_s}});
  }
  aux_.resize(std::min(kAuxCount, static_cast<Eigen::Index>(unit.aux.size())));
  output_.resize(4);
  read();
}

void BoilerProcess::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  Condition condition;
  Faults faults;
  const double wandering = solids_.next();
  for (const Change& change : changes_) {
    if (!change.when.contains(interval_)) continue;
    const Quantity& quantity = kQuantities[change.quantity];
    if (const auto* of_boiler = std::get_if<double Condition::*>(&quantity.where))
      condition.*(*of_boiler) = change.value;
    else
      faults.*std::get<double Faults::*>(quantity.where) = change.value;
  }
  condition.solids += wandering;
  solids_now_ = condition.solids;
  plant_.advance({input(0), input(1), input(2), input(3)}, condition, faults, seconds_);
  ++interval_;
  read();
}

void BoilerProcess::read() {
  const Readings& now = plant_.readings();
  output_ << now.steam_flow, now.steam_temperature, now.excess_o2, now.co;
  const std::array<double, kAuxCount> measured = {now.tertiary, now.liquor, now.liquor_temperature,
                                                  now.spray_valve, 100.0 * solids_now_};
  for (Eigen::Index i = 0; i < aux_.size(); ++i) aux_(i) = measured[static_cast<std::size_t>(i)];
}

}  // namespace mpm::sim::boiler
