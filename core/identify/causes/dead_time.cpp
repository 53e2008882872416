#include "core/identify/causes/dead_time.hpp"

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kDeadTimeName{"dead_time", "Dead time"};

constexpr double kLater[] = {0.3, 2.0, 5.0, 10.0};
constexpr double kSooner[] = {-2.0, -5.0};
constexpr double kLaterFromOnset[] = {2.0, 5.0};
constexpr double kSoonerFromOnset = -2.0;
/// Of what there is where that is less: a fit that begins at the end of its range hardly leaves it.
constexpr double kSoonerShare = 0.5;

/// A channel answers later or sooner than the model.
class DeadTime : public SingleChannelError {
 public:
  DeadTime() : SingleChannelError(kDeadTimeName) {}

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double members = cost_of(outlook.model().channels.size());
    for (const ChannelSpec& channel : outlook.model().channels) {
      const double removable = removable_samples(channel, outlook.sample_time_s());
      for (const ErrorOnset& begins : error_onsets(outlook.recording())) {
        const auto add = [&](double start) {
          found.push_back(effect(place_of(channel), {dead_time_coordinate(start, removable)},
                                 members + begins.cost, begins.row));
        };
        if (begins.row == 0) {
          for (const double start : dead_time_starts(removable)) add(start);
          continue;
        }
        for (const double start : kLaterFromOnset) add(start);
        if (removable > 0.0)
          add(removable >= -kSoonerFromOnset ? kSoonerFromOnset : -kSoonerShare * removable);
      }
    }
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return dead_time_sentence(finding, names);
  }
};

}  // namespace

std::vector<double> dead_time_starts(double removable_samples) {
  std::vector<double> starts(std::begin(kLater), std::end(kLater));
  for (const double start : kSooner)
    if (removable_samples >= -start) starts.push_back(start);
  if (removable_samples > 0.0 && removable_samples < -kSooner[0])
    starts.push_back(-kSoonerShare * removable_samples);
  return starts;
}

const Cause& dead_time() {
  static const DeadTime cause;
  return cause;
}

}  // namespace mpm::causes
