#include "daemon/live/lost_troubles.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "config/suggest.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"
#include "idl/topics.hpp"

namespace mpm::live {
namespace {

constexpr std::size_t kMostTags = 3;

const char* words_of(LossCause cause) {
  switch (cause) {
    case LossCause::kQuality:
      return "quality bad";
    case LossCause::kNoValue:
      return "no value";
    default:
      return "not plausible (frozen, at the end of its range or far outside it)";
  }
}

std::string tag_of(const config::UnitConfig& unit, const LostSignal& signal) {
  const auto at = static_cast<std::size_t>(signal.index);
  switch (signal.kind) {
    case SignalKind::kMv:
      return unit.input_tag(signal.index);
    case SignalKind::kDv:
      return unit.input_tag(unit.counts().mv + signal.index);
    case SignalKind::kPrediction:
      return unit.cv.at(at).prediction;
    default:
      return unit.cv.at(at).tag;
  }
}

// Where a topic does not come, or not in each interval, its signals have no value, which its
// trouble says; a gap that is over says it of what it left out, and of nothing behind it. That a
// clock stepped or numbers go on as they should not explains no missing value.
bool said_already(const LostSignal& signal, const std::vector<bus::Trouble>& others) {
  const std::string topic = idl::sample_topic(signal.kind);
  return std::any_of(others.begin(), others.end(), [&](const bus::Trouble& other) {
    return other.severity == bus::Severity::kFailure || other.key == bus::kNoData ||
           other.key.ends_with(" " + topic) ||
           (signal.cause == LossCause::kNoValue &&
            (other.key == "gaps" || (other.key == "jump" && signal.last_ns < other.until_ns)) &&
            other.text.find(topic) != std::string::npos);
  });
}

}  // namespace

std::vector<bus::Trouble> lost_troubles(const config::UnitConfig& unit,
                                        const std::vector<LostSignal>& lost,
                                        const std::vector<bus::Trouble>& others) {
  std::vector<bus::Trouble> troubles;
  for (const LossCause cause :
       {LossCause::kQuality, LossCause::kNoValue, LossCause::kImplausible}) {
    std::vector<std::string> tags;
    std::int64_t since_ns = std::numeric_limits<std::int64_t>::max();
    for (const LostSignal& signal : lost) {
      if (signal.cause != cause || said_already(signal, others)) continue;
      tags.push_back(tag_of(unit, signal));
      since_ns = std::min(since_ns, signal.since_ns);
    }
    if (tags.empty()) continue;
    std::string text =
        config::join({tags.begin(), tags.begin() + std::min(tags.size(), kMostTags)});
    if (tags.size() > kMostTags) text += " and " + counted(tags.size() - kMostTags, "other");
    text += tags.size() == 1 ? " is bad since " : " are bad, the first since ";
    text += files::formatted_utc(since_ns / 1'000'000'000, "%Y-%m-%dT%H:%M:%SZ");
    troubles.push_back({std::string("bad signal, ") + words_of(cause),
                        bus::Severity::kOutOfSpecification, text + ": " + words_of(cause)});
  }
  return troubles;
}

}  // namespace mpm::live
