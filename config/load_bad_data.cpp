#include <algorithm>

#include "config/load_scenario_parts.hpp"
#include "config/suggest.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

constexpr int kDefaultGap = 10, kDefaultFreeze = 30;  // samples
constexpr double kDefaultSpike = 20.0;                // s.d. of the CV's noise
constexpr Range kRun{.low = 1.0, .high = 1e6};
constexpr Range kBelowHalf{.low = 0.0, .high = 0.5, .high_open = true};

struct KindKeys {
  BadDataKind kind;
  const char* key;
  std::vector<std::string> others;
};

const std::vector<KindKeys>& kinds() {
  static const std::vector<KindKeys> list = {
      {BadDataKind::kMissing, "missing", {"tags", "run"}},
      {BadDataKind::kUncertain, "uncertain", {"tags", "run"}},
      {BadDataKind::kGaps, "gaps", {"run"}},
      {BadDataKind::kFrozen, "frozen", {"tags", "run"}},
      {BadDataKind::kSpikes, "spikes", {"tags", "run", "size"}},
      {BadDataKind::kClipping, "clipping", {"tags", "low", "high"}},
      {BadDataKind::kTimeJitter, "time_jitter", {}},
      {BadDataKind::kClockSteps, "clock_steps", {"count"}},
  };
  return list;
}

void add_tag(std::vector<std::string>& tags, const std::string& tag) {
  if (!tag.empty()) tags.push_back(tag);
}

std::vector<std::string> measured_tags(const UnitConfig& unit) {
  std::vector<std::string> tags = unit.input_tags();
  for (const CvSignal& cv : unit.cv) tags.push_back(cv.tag);
  return tags;
}

std::vector<std::string> reported_tags(const UnitConfig& unit) {
  std::vector<std::string> tags = measured_tags(unit);
  for (const CvSignal& cv : unit.cv) {
    add_tag(tags, cv.prediction);
    add_tag(tags, cv.setpoint);
  }
  return tags;
}

/// `0.05` or `5 %`.
double read_share(const Value& value, const Range& range) {
  const std::optional<Quantity> share = value.quantity({"%"});
  if (!share) return 0.0;
  const double ratio = share->unit.empty() ? share->number : share->number / 100.0;
  if (range.contains(ratio)) return ratio;
  value.error("must be a share from 0 to " + yaml_text(100.0 * range.high) +
              " %, such as 0.05 or 5 %");
  return 0.0;
}

double spike_size(const Value* value, const ScenarioContext& context, const std::string& tag,
                  const Value& item) {
  const std::vector<std::string> cvs = context.unit.cv_tags();
  const auto cv = std::find(cvs.begin(), cvs.end(), tag) - cvs.begin();
  if (cv < static_cast<std::ptrdiff_t>(cvs.size()) && value != nullptr)
    return read_size(*value, context, static_cast<int>(cv), kNotNegative);
  if (cv < static_cast<std::ptrdiff_t>(cvs.size()))
    return kDefaultSpike * noise_deviation(context, static_cast<int>(cv), item);
  const std::optional<Quantity> size =
      value != nullptr ? value->quantity({"sd"}, kNotNegative) : Quantity{0.0, "sd"};
  if (size && !size->unit.empty())
    (value != nullptr ? *value : item)
        .error("standard deviations are known of CVs only: give " + tag + " a size in its units");
  return size ? size->number : 0.0;
}

void read_clipping(const Map& map, const Value& share, BadData& bad) {
  if (const Value* low = map.find("low")) bad.low = low->number();
  if (const Value* high = map.find("high")) bad.high = high->number();
  if (bad.low && bad.high && *bad.low >= *bad.high) map.find("high")->error("must be above low");
  if (share.is_scalar() && share.free_text() == "range") {
    if (!bad.low && !bad.high) share.error("give `low` or `high`, or a share of the samples");
  } else {
    bad.share = read_share(share, {.low = 0.0, .high = 1.0});
    for (const char* key : {"low", "high"})
      if (const Value* limit = map.find(key))
        limit->error("either a share of the samples or `clipping: range` with low and high");
  }
}

void read_clock_steps(const Map& map, const Value& sizes, const ScenarioContext& context,
                      BadData& bad) {
  std::vector<double> given;
  for (const Value& size : sizes.items())
    given.push_back(read_time(size, context, kAny).value_or(0.0));
  if (given.empty()) {
    sizes.error("must not be empty");
    return;
  }
  std::size_t count = given.size();
  if (const Value* value = map.find("count"))
    count = static_cast<std::size_t>(value->integer({.low = 0, .high = 1000}).value_or(1));
  for (std::size_t i = 0; i < count; ++i) bad.steps_s.push_back(given[i % given.size()]);
  if (!context.run_s)
    sizes.error("come at random times, but the length of the run is not given (--samples)");
}

void read_run(const Map& map, BadData& bad) {
  if (bad.kind == BadDataKind::kGaps) bad.run_samples = kDefaultGap;
  if (bad.kind == BadDataKind::kFrozen) bad.run_samples = kDefaultFreeze;
  if (const Value* run = map.find("run")) bad.run_samples = run->integer(kRun).value_or(1);
}

}  // namespace

std::string name_of(BadDataKind kind) {
  for (const KindKeys& each : kinds())
    if (each.kind == kind) return each.key;
  return "";
}

void load_bad_data(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario) {
  const KindKeys* kind = nullptr;
  std::vector<std::string> known;
  for (const KindKeys& each : kinds()) {
    known.emplace_back(each.key);
    if (kind == nullptr && item.has_any_key({each.key})) kind = &each;
  }
  if (kind == nullptr) {
    item.error("give one of " + join(known));
    return;
  }
  known = kind->others;
  for (const char* key : {kind->key, "from", "until"}) known.emplace_back(key);
  const Map map = item.map(known, "key of " + std::string(kind->key));
  const Value& first = *map.find(kind->key);
  BadData bad;
  bad.kind = kind->kind;
  read_span(map, context, bad.from_s, bad.until_s);
  if (bad.kind == BadDataKind::kClockSteps) {
    read_clock_steps(map, first, context, bad);
  } else if (bad.kind == BadDataKind::kClipping) {
    read_clipping(map, first, bad);
  } else {
    bad.share = read_share(
        first, bad.kind == BadDataKind::kTimeJitter ? kBelowHalf : Range{.low = 0.0, .high = 1.0});
  }
  read_run(map, bad);
  const bool of_tags =
      std::find(kind->others.begin(), kind->others.end(), "tags") != kind->others.end();
  if (const Value* tags = map.find("tags")) {
    const std::vector<std::string> reported = reported_tags(context.unit);
    for (const Value& tag : tags->items())
      if (const int index = find_tag(tag, reported, "tag"); index >= 0)
        bad.tags.push_back(reported[static_cast<std::size_t>(index)]);
  } else if (of_tags) {
    const bool of_cvs = bad.kind == BadDataKind::kSpikes || bad.kind == BadDataKind::kClipping;
    bad.tags = of_cvs ? context.unit.cv_tags() : measured_tags(context.unit);
  }
  if (bad.kind == BadDataKind::kSpikes)
    for (const std::string& tag : bad.tags)
      bad.sizes.push_back(spike_size(map.find("size"), context, tag, item));
  scenario.bad_data.push_back(std::move(bad));
}

std::vector<Finding> add_bad_data(const std::string& text, const UnitConfig& unit,
                                  std::optional<double> run_s, ScenarioConfig& scenario) {
  std::string entry = "{";
  for (const char letter : text) entry += letter == '=' ? ": " : std::string(1, letter);
  Report report("--bad-data");
  if (const std::optional<Value> document = parse_yaml(entry + "}", report))
    load_bad_data(*document, {unit, run_s}, scenario);
  std::vector<Finding> findings = report.take();
  for (Finding& finding : findings) finding.line = finding.column = 0;  // of a text made up here
  return findings;
}

}  // namespace mpm::config
