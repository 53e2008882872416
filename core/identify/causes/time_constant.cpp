#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kTimeConstantName{"time_constant", "Time constant"};

/// Logs of ratios to begin a fit from: throughout, and from a moment on.
constexpr double kTimeConstantStarts[] = {-0.3, 0.0, 0.4};
constexpr double kStartFromOnset = 0.2;

/// A channel is slower or faster than the model.
class TimeConstant : public SingleChannelError {
 public:
  TimeConstant() : SingleChannelError(kTimeConstantName) {}

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double members = cost_of(outlook.model().channels.size());
    for (const ChannelSpec& channel : outlook.model().channels) {
      for (const ErrorOnset& begins : error_onsets(outlook.recording())) {
        const auto add = [&](double start) {
          found.push_back(effect(place_of(channel), {time_constant_coordinate(start)},
                                 members + begins.cost, begins.row));
        };
        if (begins.row > 0) {
          add(kStartFromOnset);
        } else {
          for (const double start : kTimeConstantStarts) add(start);
        }
      }
    }
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return time_constant_sentence(finding, names);
  }
};

}  // namespace

const Cause& time_constant() {
  static const TimeConstant cause;
  return cause;
}

}  // namespace mpm::causes
