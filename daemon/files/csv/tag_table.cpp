#include "daemon/files/csv/tag_table.hpp"

#include <functional>
#include <set>
#include <utility>

#include "config/suggest.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/tag_names.hpp"

namespace mpm::files {
namespace {

/// The one of `names` that `tag` is most likely a slip of, without what may decorate it.
std::string likely_name(const std::string& tag, const std::vector<std::string>& names) {
  std::vector<std::string> forms, names_of_forms;
  for (const std::string& name : names)
    for (std::string& form : plain_tags(name)) {
      forms.push_back(std::move(form));
      names_of_forms.push_back(name);
    }
  const std::string* likely = config::closest(tag, forms);
  return likely == nullptr ? std::string()
                           : names_of_forms[static_cast<std::size_t>(likely - forms.data())];
}

}  // namespace

TagTable::TagTable(const config::UnitConfig& unit, Purpose purpose)
    : unit_(unit), purpose_(purpose) {
  const auto add = [this](const std::string& tag, SignalKind kind, std::size_t index) {
    if (tag.empty() || unit_.calculation_of(tag) != nullptr) return;
    slots_[tag] = {kind, static_cast<int>(index)};
    const auto [entry, is_new] = folded_.emplace(folded(tag), tag);
    if (!is_new && entry->second != tag) entry->second.clear();
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

const std::string* TagTable::tag_of(std::string_view name) const {
  const std::string text(name);
  if (const auto found = slots_.find(text); found != slots_.end()) return &found->first;
  const auto read = read_as_.find(text);
  if (read == read_as_.end()) return nullptr;
  const std::vector<std::string>* readings = readings_of(read->second);
  return readings != nullptr && readings->size() == 1 ? &read->second : nullptr;
}

const Slot* TagTable::find(std::string_view name) const {
  const std::string* tag = tag_of(name);
  return tag == nullptr ? nullptr : &slots_.find(*tag)->second;
}

void TagTable::see(std::string_view name) {
  const auto [entry, is_new] = seen_.emplace(name, true);
  if (!is_new || slots_.find(entry->first) != slots_.end()) return;
  if (unit_.calculation_of(name) != nullptr) {
    recalculated_.push_back(printable(entry->first));
    return;
  }
  others_.push_back(entry->first);
  const std::string tag = likely_tag(name);
  if (tag.empty()) return;
  read_as_.emplace(name, tag);
  readings_[tag].emplace_back(name);
}

bool TagTable::seen(const std::string& tag) const {
  return seen_.count(tag) > 0 || readings_of(tag) != nullptr;
}

std::string TagTable::likely_tag(std::string_view name) const {
  const std::vector<std::string> forms = plain_tags(name);
  for (const std::string& form : forms)
    if (slots_.find(form) != slots_.end()) return form;
  for (const std::string& form : forms)
    if (const auto found = folded_.find(folded(form)); found != folded_.end()) return found->second;
  return {};
}

const std::vector<std::string>* TagTable::readings_of(const std::string& tag) const {
  const auto found = readings_.find(tag);
  return found == readings_.end() || seen_.count(tag) > 0 ? nullptr : &found->second;
}

std::string TagTable::two_names_problem() const {
  for (const auto& [tag, names] : readings_)
    if (names.size() > 1 && seen_.count(tag) == 0)
      return "both '" + printable(names[0]) + "' and '" + printable(names[1]) + "' may be '" + tag +
             "': give the one that is meant this name";
  return {};
}

std::vector<std::string> TagTable::ignored() const {
  std::vector<std::string> names;
  for (const std::string& name : others_)
    if (tag_of(name) == nullptr) names.push_back(printable(name));
  return names;
}

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
  if (std::string two_names = two_names_problem(); !two_names.empty()) return two_names;
  const std::vector<std::string> ignored = this->ignored();
  if (purpose_ == Purpose::kKeep)
    return absent().size() < slots_.size() || slots_.empty()
               ? std::string()
               : "the file holds no signal of unit '" + unit_.unit + "'" +
                     (ignored.empty() ? "" : "; it holds " + config::join(ignored));
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
    const std::string likely = likely_name(tag, ignored);
    unlike = unlike || likely.empty();
    if (!likely.empty()) missing += " (did you mean '" + likely + "'?)";
  };
  for (const auto& mv : unit_.mv) need(mv.tag, "mv");
  for (const auto& dv : unit_.dv) need(dv.tag, "dv");
  for (const auto& cv : unit_.cv) {
    need(cv.tag, "cv");
    if (!unit_.has_model()) need(cv.prediction, "prediction");
  }
  if (missing.empty()) return {};
  const std::string others =
      unlike && !ignored.empty() ? "; it holds " + config::join(ignored) : "";
  return "the file does not hold " + missing + others;
}

std::string TagTable::readings() const {
  std::vector<std::string> read;
  for (const std::string& name : others_)
    if (const std::string* tag = tag_of(name))
      read.push_back("'" + printable(name) + "' as " + *tag);
  return read.empty() ? std::string()
                      : "columns read as tags of the unit file: " + config::join(read);
}

std::vector<std::string> TagTable::notices() const {
  std::vector<std::string> notices;
  if (std::string read = readings(); !read.empty()) notices.push_back(std::move(read));
  if (const std::vector<std::string> ignored = this->ignored(); !ignored.empty())
    notices.push_back("ignored, since the unit file does not name them: " + config::join(ignored));
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
