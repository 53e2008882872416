#include "daemon/files/csv/tag_table.hpp"

#include <functional>
#include <set>

#include "config/suggest.hpp"
#include "core/text/printable.hpp"

namespace mpm::files {

TagTable::TagTable(const config::UnitConfig& unit, Purpose purpose)
    : unit_(unit), purpose_(purpose) {
  const auto add = [this](const std::string& tag, SignalKind kind, std::size_t index) {
    if (!tag.empty() && unit_.calculation_of(tag) == nullptr)
      slots_[tag] = {kind, static_cast<int>(index)};
  };
  for (std::size_t i = 0; i < unit.mv.size(); ++i) add(unit.mv[i].tag, SignalKind::kMv, i);
  for (std::size_t i = 0; i < unit.dv.size(); ++i) add(unit.dv[i].tag, SignalKind::kDv, i);
  for (std::size_t i = 0; i < unit.aux.size(); ++i) add(unit.aux[i].tag, SignalKind::kAux, i);
  for (std::size_t i = 0; i < unit.raw.size(); ++i) add(unit.raw[i].tag, SignalKind::kRaw, i);
  for (std::size_t i = 0; i < unit.cv.size(); ++i) {
    add(unit.cv[i].tag, SignalKind::kCv, i);
    add(unit.cv[i].prediction, SignalKind::kPrediction, i);
    add(unit.cv[i].setpoint, SignalKind::kSetpoint, i);
  }
}

const Slot* TagTable::find(std::string_view tag) const {
  const auto found = slots_.find(std::string(tag));
  return found == slots_.end() ? nullptr : &found->second;
}

void TagTable::see(std::string_view tag) {
  const auto [entry, is_new] = seen_.emplace(tag, true);
  if (!is_new || slots_.find(entry->first) != slots_.end()) return;
  if (unit_.calculation_of(tag) != nullptr)
    recalculated_.push_back(printable(entry->first));
  else
    ignored_.push_back(printable(entry->first));
}

bool TagTable::seen(const std::string& tag) const { return seen_.count(tag) > 0; }

// In the order of the kinds.
std::vector<std::string> TagTable::absent() const {
  std::vector<std::string> tags;
  const auto look = [&](const std::string& tag) {
    if (slots_.find(tag) != slots_.end() && !seen(tag)) tags.push_back(tag);
  };
  for (const auto& mv : unit_.mv) look(mv.tag);
  for (const auto& dv : unit_.dv) look(dv.tag);
  for (const auto& cv : unit_.cv) look(cv.tag);
  for (const auto& cv : unit_.cv) look(cv.prediction);
  for (const auto& cv : unit_.cv) look(cv.setpoint);
  for (const auto& aux : unit_.aux) look(aux.tag);
  for (const auto& raw : unit_.raw) look(raw.tag);
  return tags;
}

std::string TagTable::problem() const {
  if (purpose_ == Purpose::kKeep)
    return absent().size() < slots_.size() || slots_.empty()
               ? std::string()
               : "the file holds no signal of unit '" + unit_.unit + "'" +
                     (ignored_.empty() ? "" : "; it holds " + config::join(ignored_));
  std::string missing;
  bool unlike = false;  // a tag that no column of the file resembles
  std::set<std::string> told;
  std::function<void(const std::string&, const std::string&)> need;  // by way of expressions
  need = [&](const std::string& tag, const std::string& what) {
    if (const config::CalculatedSignal* signal = unit_.calculation_of(tag)) {
      if (told.insert(tag).second)
        for (const std::string& input : signal->inputs)
          need(input, "what '" + signal->tag + "' is calculated from,");
      return;
    }
    if (tag.empty() || seen(tag) || !told.insert(tag).second) return;
    missing += (missing.empty() ? "" : ", ") + what + " '" + tag + "'";
    const std::string* likely = config::closest(tag, ignored_);
    unlike = unlike || likely == nullptr;
    if (likely != nullptr) missing += " (did you mean '" + *likely + "'?)";
  };
  for (const auto& mv : unit_.mv) need(mv.tag, "mv");
  for (const auto& dv : unit_.dv) need(dv.tag, "dv");
  for (const auto& cv : unit_.cv) {
    need(cv.tag, "cv");
    if (!unit_.has_model()) need(cv.prediction, "prediction");
  }
  if (missing.empty()) return {};
  const std::string others =
      unlike && !ignored_.empty() ? "; it holds " + config::join(ignored_) : "";
  return "the file does not hold " + missing + others;
}

std::vector<std::string> TagTable::notices() const {
  std::vector<std::string> notices;
  if (!ignored_.empty())
    notices.push_back("ignored, since the unit file does not name them: " + config::join(ignored_));
  if (!recalculated_.empty())
    notices.push_back("not taken from the file, since the unit file calculates them: " +
                      config::join(recalculated_));
  if (purpose_ == Purpose::kKeep) {
    const std::vector<std::string> lacking = absent();
    if (!lacking.empty())
      notices.push_back("signals of the unit that are not in the file: " + config::join(lacking));
    return notices;
  }
  std::vector<std::string> simulated, absent_aux, absent_raw;
  for (const auto& cv : unit_.cv)
    if (slots_.find(cv.prediction) != slots_.end() && !seen(cv.prediction))
      simulated.push_back(cv.prediction);
  if (!simulated.empty())
    notices.push_back("not in the file, so the unit file's model simulates instead: " +
                      config::join(simulated));
  for (const auto& aux : unit_.aux)
    if (slots_.find(aux.tag) != slots_.end() && !seen(aux.tag)) absent_aux.push_back(aux.tag);
  for (const auto& raw : unit_.raw)
    if (!seen(raw.tag)) absent_raw.push_back(raw.tag);
  if (!absent_aux.empty())
    notices.push_back("aux tags that are not in the file: " + config::join(absent_aux));
  if (!absent_raw.empty())
    notices.push_back("raw tags that are not in the file, nor is what is calculated from them: " +
                      config::join(absent_raw));
  return notices;
}

}  // namespace mpm::files
