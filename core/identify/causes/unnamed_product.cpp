#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/unnamed_channel.hpp"

namespace mpm::causes {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// s.d. of how much of its gain a channel may win or lose on the way.
constexpr double kModulation = 0.15;

/// Last known value where one is missing; mean 0, half the way from the 1st to the 99th percentile
/// 1. Empty where it does not move.
VectorXd normalised(const Eigen::Ref<const VectorXd>& values) {
  constexpr std::size_t kFewest = 20;
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  if (sorted.size() < kFewest) return {};
  std::sort(sorted.begin(), sorted.end());
  const std::size_t margin = sorted.size() / 100;
  const double reach = 0.5 * (sorted[sorted.size() - 1 - margin] - sorted[margin]);
  if (!(reach > 0.0)) return {};
  double mean = 0.0;
  for (const double value : sorted) mean += value / static_cast<double>(sorted.size());
  VectorXd result(values.size());
  double last = mean;
  for (Index k = 0; k < values.size(); ++k) {
    if (std::isfinite(values(k))) last = values(k);
    result(k) = (last - mean) / reach;
  }
  return result;
}

/// A channel's gain moves with another input.
class Product : public UnnamedBehaviour {
 public:
  Product() : UnnamedBehaviour("product") {}

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const int other = finding.other_input;
    return ", whose effect seems to change with " +
           (other >= 0 ? names.input(other).tag : std::string("another input"));
  }

 protected:
  void propose_for(const ActiveChannel& channel, const Outlook& outlook, const CvFit&,
                   std::vector<Effect>& found) const override {
    for (int other = 0; other < outlook.inputs(); ++other) {
      if (other == channel.spec().input) continue;
      const VectorXd by = normalised(outlook.recording().inputs.col(other));
      if (by.size() == 0) continue;
      found.push_back(shaped(channel, {channel.modulated(by)}, kModulation,
                             cost_of(static_cast<std::size_t>(outlook.inputs()))));
      found.back().other_input = other;
    }
  }
};

}  // namespace

const Cause& unnamed_product() {
  static const Product cause;
  return cause;
}

}  // namespace mpm::causes
