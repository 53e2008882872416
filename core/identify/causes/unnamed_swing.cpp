#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/periodogram.hpp"
#include "core/identify/causes/unnamed_channel.hpp"
#include "core/identify/fit/misfit_slope.hpp"

namespace mpm::causes {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// s.d. of how much of its gain a channel may win or lose on the way.
constexpr double kModulation = 0.15;
/// A gain swings at least so often in the data, and at most once in so many samples.
constexpr int kFewestSwings = 2;
constexpr double kShortestSwing = 60.0;
/// Frequencies fitted for each channel.
constexpr std::size_t kSwings = 2;

/// A channel's gain swings with time.
class Swing : public UnnamedBehaviour {
 public:
  Swing() : UnnamedBehaviour("swing") {}

  [[nodiscard]] std::string sentence(const Finding&, const SignalNames&) const override {
    return ", whose effect seems to swing with time";
  }

 protected:
  /// Where the innovations and the channel's response beat against each other.
  void propose_for(const ActiveChannel& channel, const Outlook& outlook, const CvFit& without,
                   std::vector<Effect>& found) const override {
    const Index samples = outlook.problem.samples();
    const auto length = static_cast<double>(samples);
    const VectorXd beat =
        misfit_slope(outlook.problem.data(without.cv), without).cwiseProduct(channel.response());
    struct Cycle {
      double power, frequency;  // per sample
    };
    std::vector<Cycle> all;
    const auto most = static_cast<int>(2.0 * length / kShortestSwing);
    for (int half = 2 * kFewestSwings; half <= most; ++half) {
      const double frequency = 0.5 * half / length;
      all.push_back({power_at(beat, 2.0 * std::numbers::pi * frequency), frequency});
    }
    std::sort(all.begin(), all.end(),
              [](const Cycle& x, const Cycle& y) { return x.power > y.power; });
    VectorXd sine(samples), cosine(samples);
    for (std::size_t i = 0; i < std::min(kSwings, all.size()); ++i) {
      for (Index k = 0; k < samples; ++k) {
        const double angle = 2.0 * std::numbers::pi * all[i].frequency * static_cast<double>(k);
        sine(k) = std::sin(angle), cosine(k) = std::cos(angle);
      }
      found.push_back(shaped(
          channel, {channel.response().cwiseProduct(sine), channel.response().cwiseProduct(cosine)},
          kModulation, cost_of(all.size())));
    }
  }
};

}  // namespace

const Cause& unnamed_swing() {
  static const Swing cause;
  return cause;
}

}  // namespace mpm::causes
