#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "config/engineering_unit.hpp"
#include "config/formula.hpp"
#include "config/load_sections.hpp"
#include "config/suggest.hpp"

namespace mpm::config {
namespace {

constexpr std::size_t kMostCalculated = 1000;

bool is_plain(const std::string& tag) {
  return tag.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.") ==
             std::string::npos &&
         tag.find_first_of("0123456789.") != 0;
}

class CalculationReader {
 public:
  CalculationReader(const Map& section, UnitConfig& config) : config_(config) {
    const auto name = [this](const std::string& tag, const std::string& unit) {
      if (!tag.empty()) units_.emplace(tag, unit);
    };
    for (const auto* list : {&config.mv, &config.dv, &config.aux, &config.raw})
      for (const InputSignal& signal : *list) name(signal.tag, signal.unit);
    for (const CvSignal& cv : config.cv)
      for (const std::string& tag : {cv.tag, cv.prediction, cv.setpoint}) name(tag, cv.unit);
    for (const auto& [tag, unit] : units_) named_.insert(tag);
    if (section.entries().size() > kMostCalculated) {
      section.place().error("more than " + std::to_string(kMostCalculated) + " calculated tags");
      return;
    }
    for (const Map::Entry& entry : section.entries()) sound_ = read(entry) && sound_;
  }

  void finish() {
    check_names();
    sort();
    for (const std::size_t i : order_) check_unit(items_[i]);
    for (Item& item : items_)
      if (used_.count(item.signal.tag) == 0 && named_.count(item.signal.tag) == 0)
        item.place.warning("no signal is called so and no other expression uses it");
    for (const std::size_t i : order_) config_.calc.push_back(std::move(items_[i].signal));
  }

  /// Always, where an expression could not be read: it may be what uses it.
  [[nodiscard]] bool uses(const std::string& tag) const { return !sound_ || used_.count(tag) > 0; }

 private:
  struct Item {
    CalculatedSignal signal;
    Value place;       ///< of the key
    Value expression;  ///< the text
    Formula formula;
    enum class State { kNew, kOpen, kSorted } state = State::kNew;
  };

  static bool refuse(const Map::Entry& entry, const std::string& message) {
    entry.key_at.error(message);
    return false;
  }

  bool read(const Map::Entry& entry) {
    CalculatedSignal signal;
    signal.tag = entry.key;
    if (signal.tag.empty() || signal.tag.size() > kLongestTag)
      return refuse(entry, "a tag has 1 to " + std::to_string(kLongestTag) + " bytes");
    if (std::any_of(config_.raw.begin(), config_.raw.end(),
                    [&](const InputSignal& raw) { return raw.tag == signal.tag; }))
      return refuse(entry, "is calculated, so it is not `raw`, which is measured");
    const Value* text = &entry.value;
    std::optional<Map> map;
    if (entry.value.is_map()) {
      map.emplace(entry.value.map({"expression", "unit"}));
      if (const Value* unit = map->find("unit")) {
        signal.unit = unit->free_text().value_or("");
        take_unit(*unit, signal);
      }
      text = map->require("expression");
      if (text == nullptr) return false;
    }
    const std::optional<std::string> expression = text->text(kLongestFormula);
    if (!expression) return false;
    signal.expression = *expression;
    if (signal.unit.empty()) signal.unit = units_[signal.tag];
    units_[signal.tag] = signal.unit;
    try {
      Formula formula(*expression);
      signal.inputs = formula.tags();
      items_.push_back({std::move(signal), entry.key_at, *text, std::move(formula)});
      return true;
    } catch (const FormulaError& error) {
      text->error_at(error.at, error.what());
      return false;
    }
  }

  /// A unit may stand with the signal, with the expression, or the same with both.
  void take_unit(const Value& place, const CalculatedSignal& signal) {
    const std::string& known = units_[signal.tag];
    if (!known.empty() && !signal.unit.empty() && known != signal.unit)
      place.error("the signal '" + signal.tag + "' is given in " + known);
  }

  void check_names() {
    std::vector<std::string> known;
    for (const auto& [tag, unit] : units_) known.push_back(tag);
    for (Item& item : items_)
      for (const Formula::Name& name : item.formula.names()) {
        used_.insert(name.tag);
        if (units_.count(name.tag) > 0) continue;
        sound_ = false;
        item.expression.error_at(
            name.at, "'" + name.tag + "' is no tag of this unit" + help(name.tag, known));
      }
  }

  static std::string help(const std::string& tag, const std::vector<std::string>& known) {
    const auto longer = std::find_if(known.begin(), known.end(), [&](const std::string& other) {
      return !is_plain(other) && other.starts_with(tag);
    });
    if (longer != known.end()) return "; write '" + *longer + "' in braces: {" + *longer + "}";
    const std::string likely = suggestion(tag, known);
    return likely.starts_with(" (did")
               ? likely
               : likely + "; what is measured only to calculate with stands in `raw`";
  }

  /// Each behind those that it uses, in the file's order where that leaves a choice.
  void sort() {
    for (std::size_t i = 0; i < items_.size(); ++i) visit(i);
  }

  void visit(std::size_t i) {
    Item& item = items_[i];
    if (item.state == Item::State::kSorted) return;
    item.state = Item::State::kOpen;
    path_.push_back(i);
    for (const Formula::Name& name : item.formula.names()) {
      const auto other = std::find_if(items_.begin(), items_.end(), [&](const Item& candidate) {
        return candidate.signal.tag == name.tag;
      });
      if (other == items_.end()) continue;
      if (other->state == Item::State::kOpen)
        item.expression.error_at(name.at,
                                 "'" + name.tag + "' is calculated from itself: " +
                                     circle(static_cast<std::size_t>(other - items_.begin())));
      else
        visit(static_cast<std::size_t>(other - items_.begin()));
    }
    path_.pop_back();
    item.state = Item::State::kSorted;
    order_.push_back(i);
  }

  [[nodiscard]] std::string circle(std::size_t first) const {
    std::string text;
    for (auto at = std::find(path_.begin(), path_.end(), first); at != path_.end(); ++at)
      text += items_[*at].signal.tag + " <- ";
    return text + items_[first].signal.tag;
  }

  void check_unit(const Item& item) {
    const auto unit_of = [this](const std::string& tag) {
      if (const auto found = derived_.find(tag); found != derived_.end())
        return std::optional(found->second);
      const auto found = units_.find(tag);
      return found == units_.end() || found->second.empty() ? std::nullopt
                                                            : EngineeringUnit::parse(found->second);
    };
    std::vector<std::optional<EngineeringUnit>> units;
    for (const std::string& tag : item.formula.tags()) units.push_back(unit_of(tag));
    try {
      const std::optional<EngineeringUnit> result = item.formula.unit(units);
      const std::optional<EngineeringUnit> wanted = unit_of(item.signal.tag);
      if (result && !wanted) derived_.emplace(item.signal.tag, *result);
      if (result && wanted && *result != *wanted)
        item.expression.error_at(
            0, "gives " + to_string(*result) + ", and '" + item.signal.tag + "' is in " +
                   item.signal.unit +
                   "; nothing is converted, but a number as a factor may have any unit");
    } catch (const FormulaError& error) {
      item.expression.error_at(error.at, error.what());
    }
  }

  UnitConfig& config_;
  std::map<std::string, std::string> units_;        // of all tags; "" = not given
  std::map<std::string, EngineeringUnit> derived_;  // of expressions whose tag has no unit
  std::set<std::string> named_, used_;              // as signals; in expressions
  std::vector<Item> items_;
  bool sound_ = true;  // every expression could be read and names known tags
  std::vector<std::size_t> order_, path_;
};

}  // namespace

void load_calculated(const Map& signals, UnitConfig& config) {
  const Value* section = signals.find("calc");
  CalculationReader reader(
      section != nullptr && !section->is_null() ? section->map_of_any() : Map(signals.place(), {}),
      config);
  reader.finish();
  if (signals.find("raw") == nullptr) return;
  for (const InputSignal& raw : config.raw)
    if (!raw.tag.empty() && !reader.uses(raw.tag))
      signals.find("raw")->warning("no expression uses '" + raw.tag + "'");
}

}  // namespace mpm::config
