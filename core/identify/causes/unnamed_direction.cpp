#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/unnamed_channel.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm::causes {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// s.d. of the log of how much slower a channel may rise than fall.
constexpr double kAsymmetry = 0.3;

/// A channel rises slower than it falls, or the other way round.
class Direction : public UnnamedBehaviour {
 public:
  Direction() : UnnamedBehaviour("direction") {}

  [[nodiscard]] std::string sentence(const Finding&, const SignalNames&) const override {
    return ", whose effect seems slower one way than the other";
  }

 protected:
  void propose_for(const ActiveChannel& channel, const Outlook&, const CvFit&,
                   std::vector<Effect>& found) const override {
    found.push_back(shaped(channel, {slower_up(channel)}, kAsymmetry, cost_of(1)));
  }

 private:
  /// What it gives less while it rises and more while it falls, per unit of log time constant.
  static VectorXd slower_up(const ActiveChannel& channel) {
    const double sample_time_s = channel.model().sample_time_s;
    const VectorXd& response = channel.response();
    const double lag = slowest_time_constant_s(channel.spec(), sample_time_s) / sample_time_s;
    const double pole = std::exp(-1.0 / lag);
    VectorXd result = VectorXd::Zero(response.size());
    for (Index k = 1; k < result.size(); ++k)
      result(k) = pole * result(k - 1) - std::abs(response(k) - response(k - 1));
    return result;
  }
};

}  // namespace

const Cause& unnamed_direction() {
  static const Direction cause;
  return cause;
}

}  // namespace mpm::causes
