#include "core/identify/diagnosis/rejected.hpp"

#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/calibration.hpp"

namespace mpm {
namespace {

struct Level {
  double match = kSurelyRejected;    ///< p-value of the channel's match
  double harmless = kSurelyMatters;  ///< and of its error being too small to matter
};

bool rejects(const ChannelTests& tests, int cv, int input, const Level& level = {}) {
  return tests.p_value(cv, input).value_or(1.0) <= level.match &&
         tests.harmless_p_value(cv, input) <= level.harmless;
}

bool is_about(const Subject& subject, const ChannelSpec& channel) {
  const Place& place = subject.place;
  return !causes::is_from_outside(subject) && (place.cv < 0 || place.cv == channel.cv) &&
         (place.input < 0 || place.input == channel.input);
}

/// Those of the model for which `is_so(cv, input)` and that nothing named or seen is about.
template <class IsSo>
std::vector<Place> untold(const ModelSpec& model, const Diagnosis& diagnosis, const IsSo& is_so) {
  std::vector<Place> channels;
  for (const ChannelSpec& channel : model.channels) {
    const auto told = [&](const auto& each) { return is_about(each.subject, channel); };
    if (is_so(channel.cv, channel.input) &&
        std::none_of(diagnosis.findings.begin(), diagnosis.findings.end(), told) &&
        std::none_of(diagnosis.small.begin(), diagnosis.small.end(), told) &&
        std::none_of(diagnosis.unexplained.begin(), diagnosis.unexplained.end(), told))
      channels.push_back({channel.cv, channel.input});
  }
  return channels;
}

}  // namespace

std::vector<Place> rejected_channels(const ModelSpec& model, const ChannelTests& tests,
                                     const Diagnosis& diagnosis) {
  Level level;
  if (diagnosis.findings.empty() && diagnosis.unexplained.empty())
    level = {kDoubted / static_cast<double>(model.channels.size()), kDoubted};
  return untold(model, diagnosis,
                [&](int cv, int input) { return rejects(tests, cv, input, level); });
}

std::vector<Place> bent_channels(const ModelSpec& model, const ChannelTests& tests,
                                 const Diagnosis& diagnosis) {
  return untold(model, diagnosis, [&](int cv, int input) { return tests.bends({{cv, input}}); });
}

void keep_rejected(const ChannelTests& repaired, std::vector<Place>& channels) {
  std::erase_if(channels, [&](const Place& channel) {
    return !rejects(repaired, channel.cv, channel.input);
  });
}

}  // namespace mpm
