#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/linear_model.hpp"
#include "daemon/history/trend/trend.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::test {

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::int64_t kMonday = 1'767'571'200 * kSecond;  // 2026-01-05T00:00:00Z

/// One input, one CV with a prediction of its own, a sample a minute: digests of a quarter of an
/// hour.
inline config::UnitConfig minute_unit() {
  config::UnitConfig unit;
  unit.unit = "minute";
  unit.mv = {{"u", "t/h", ""}};
  unit.cv.resize(1);
  unit.cv[0].tag = "y";
  unit.cv[0].unit = "%";
  unit.cv[0].prediction = "yhat";
  unit.model.sample_time_s = unit.sample_time_s = 60.0;
  unit.model.input_count = unit.model.cv_count = 1;
  unit.model.input_blocks.resize(1);
  unit.model.output_blocks.resize(1);
  unit.model.input_origin = unit.model.output_origin = Eigen::VectorXd::Zero(1);
  unit.model.channels = {{0, 0, TransferFunction{2.0, {600.0}, 0, 0, false}}};
  return unit;
}

/// Frames of that unit: the input moves, the plant has `ratio` of the gain, the residual has noise.
class MinuteFrames {
 public:
  explicit MinuteFrames(double ratio = 1.0)
      : unit_(minute_unit()), model_(unit_.model), frame_(unit_.counts()) {
    ratio_ = ratio;
    for (SignalBlock& block : frame_.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
  }
  const Frame& next() {
    const Eigen::VectorXd u =
        Eigen::VectorXd::Constant(1, (uniform(1, k_ / 7) > 0 ? 1.0 : -1.0) + 0.01 * uniform(3, k_));
    frame_.interval = k_;
    frame_.source_time_ns = kMonday + k_ * 60 * kSecond;
    frame_[SignalKind::kMv].values = u;
    frame_[SignalKind::kPrediction].values = model_.output();
    frame_[SignalKind::kCv].values = ratio_ * model_.output();
    frame_[SignalKind::kCv].values(0) += 0.05 * coloured(2, k_);
    model_.advance(u);
    ++k_;
    return frame_;
  }
  void set_ratio(double ratio) { ratio_ = ratio; }

 private:
  config::UnitConfig unit_;
  LinearModel model_;
  Frame frame_;
  double ratio_ = 1.0;
  std::int64_t k_ = 0;
};

/// Of a unit with the input u, the CV y, and a sample a minute.
inline history::UnitHead sample_head() {
  history::UnitHead head;
  head.unit = "sample";
  head.sample_time_s = 60.0;
  head.digest_s = 900.0;
  head.horizon_samples = 10;
  head.cvs = {{"y", "%"}};
  head.channels = {{"u", "y", "t/h", true, 0.05}};
  return head;
}

/// A quarter of an hour.
inline history::Digest sample_digest(std::int64_t from_ns, double gain_error, double error) {
  history::Digest digest;
  digest.from_ns = from_ns;
  digest.until_ns = from_ns + 14 * 60 * kSecond;
  digest.samples = 15;
  digest.cvs = {{"y", 15, 0.5 * error, 15, error, 4.0}};
  history::ChannelDigest channel;
  channel.mv = "u";
  channel.cv = "y";
  channel.match = std::abs(gain_error) < 5.0 ? 15 : 0;
  channel.mismatch = 15 - channel.match;
  channel.excited = 15;
  channel.verdict = channel.match > 0 ? "match" : "mismatch";
  channel.gain_error = gain_error;
  channel.low = gain_error - 2.0;
  channel.high = gain_error + 2.0;
  channel.smallest_error = 0.06;
  channel.effective_samples = 400.0;
  digest.channels = {channel};
  return digest;
}

/// What a unit says for so many quarters of an hour, with `of(quarter)` its digest.
template <class Of>
history::Trend sample_trend(int quarters, Of of, std::optional<history::Step> step = {},
                            const files::TimeZone* zone = nullptr) {
  history::TrendMaker maker(step, zone);
  maker.add(sample_head());
  for (int q = 0; q < quarters; ++q) maker.add(of(q, kMonday + q * 900 * kSecond));
  return maker.finish();
}

/// A sample trend by day whose gain error goes from 0 to `gain` % and whose prediction errors from
/// 0.1 to `error` at the day `change` of `days`, with a little noise.
inline history::Trend changing_trend(int days, int change, double gain, double error) {
  return sample_trend(
      96 * days,
      [=](int q, std::int64_t at) {
        const bool after = q / 96 >= change;
        return sample_digest(at, (after ? gain : 0.0) + 0.3 * uniform(7, q),
                             (after ? error : 0.1) * (1.0 + 0.1 * uniform(8, q)));
      },
      history::Step::kDay);
}

}  // namespace mpm::test
