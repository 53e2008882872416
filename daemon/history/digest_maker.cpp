#include "daemon/history/digest_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/model/linear_model.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/signal/nanoseconds.hpp"
#include "core/text/words.hpp"
#include "daemon/report/channel_text.hpp"

namespace mpm::history {
namespace {

constexpr double kFewestSamples = 10.0;  // of a digest, where they fit
constexpr std::int64_t kLongestHorizon = 3600;
constexpr double kWidestInterval = 200.0;  // %, beyond which a gain is not resolved

double window_s(double sample_time_s) {
  for (const double window : {60.0, 300.0})
    if (window >= kFewestSamples * sample_time_s) return window;
  return 900.0;
}

DerivedSettings derived_of(const config::UnitConfig& unit) {
  return derive_settings(unit.model, LinearModel(unit.model), unit.monitor, unit.alarms);
}

// To six digits: what a journal keeps, and all that is meant.
double rounded(double value) {
  if (!std::isfinite(value)) return kUnknown;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5e", value);
  return std::strtod(text.data(), nullptr);
}

double rms(double square, std::int64_t count) {
  return count > 0 ? rounded(std::sqrt(square / static_cast<double>(count))) : kUnknown;
}

}  // namespace

std::int64_t horizon_samples(const config::UnitConfig& unit) {
  return std::clamp<std::int64_t>(derived_of(unit).settling_samples / 2, 1, kLongestHorizon);
}

DigestMaker::DigestMaker(const config::UnitConfig& unit)
    : inputs_(unit.counts().inputs()),
      cv_count_(unit.counts().cv),
      predictions_(cv_count_, {horizon_samples(unit)}) {
  const DerivedSettings derived = derived_of(unit);
  head_.unit = unit.unit;
  head_.sample_time_s = unit.sample_time_s;
  head_.digest_s = window_s(unit.sample_time_s);
  head_.horizon_samples = horizon_samples(unit);
  window_ns_ = std::llround(head_.digest_s * kNsPerSecond);
  for (const config::CvSignal& cv : unit.cv) head_.cvs.push_back({cv.tag, cv.unit});
  for (int i = 0; i < inputs_; ++i) {
    for (int j = 0; j < cv_count_; ++j) {
      const std::string& cv = unit.cv[static_cast<std::size_t>(j)].tag;
      const report::ChannelFile file = report::channel_file(unit, unit.input_tag(i), cv);
      head_.channels.push_back(
          {unit.input_tag(i), cv, file.mv_unit, file.modelled,
           derived.materiality[static_cast<std::size_t>(i * cv_count_ + j)].gain,
           i >= unit.counts().mv});
    }
  }
  const SignalCounts counts = unit.counts();
  for (int i = 0; i < counts.inputs() + counts.cv + counts.aux; ++i)
    mover_tags_.push_back(unit.mover_tag(i));
  cvs_.resize(head_.cvs.size());
  readings_.resize(head_.cvs.size());
  channels_.resize(head_.channels.size());
  status_.resize(head_.channels.size());
  alarms_.resize(head_.channels.size());
}

UnitHead DigestMaker::head(std::int64_t time_ns) const {
  UnitHead head = head_;
  head.time_ns = time_ns;
  return head;
}

std::optional<Digest> DigestMaker::push(const report::UnitMonitor& monitor) {
  const std::int64_t window = floor_division(monitor.source_time_ns(), window_ns_);
  std::optional<Digest> before;
  if (samples_ > 0 && window != window_) before = finish();
  if (samples_ == 0) {
    window_ = window;
    from_ns_ = monitor.source_time_ns();
  }
  until_ns_ = monitor.source_time_ns();
  ++samples_;
  take(monitor.monitor());
  return before;
}

void DigestMaker::take(const Monitor& monitor) {
  for (int i = 0; i < inputs_; ++i) {
    for (int j = 0; j < cv_count_; ++j) {
      const auto at = static_cast<std::size_t>(i * cv_count_ + j);
      status_[at] = monitor.channel(j, i);
      alarms_[at] = monitor.alarm(j, i);
      Channel& channel = channels_[at];
      if (status_[at].verdict == Verdict::kMatch) ++channel.match;
      if (status_[at].verdict == Verdict::kMismatch) ++channel.mismatch;
      if (status_[at].excited) ++channel.excited;
    }
  }
  take_readings(monitor);
}

void DigestMaker::take_readings(const Monitor& monitor) {
  for (const JudgedFrame& judged : monitor.judged()) {
    for (std::size_t j = 0; j < cvs_.size(); ++j) {
      CvReading& reading = readings_[j] = judged.readings[j];
      if (reading.early) reading = {};  // a digest is written, and not taken back
      if (!std::isfinite(reading.residual)) continue;
      ++cvs_[j].known;
      cvs_[j].residual_square += reading.residual * reading.residual;
    }
    predictions_.push(
        judged.interval, readings_,
        [this](std::size_t cv, std::size_t) -> PredictionSums& { return cvs_[cv].predictions; });
  }
}

ChannelDigest DigestMaker::digest_of(std::size_t channel) const {
  const ChannelStatus& status = status_[channel];
  const ChannelHead& head = head_.channels[channel];
  ChannelDigest digest;
  digest.mv = head.mv;
  digest.cv = head.cv;
  digest.match = channels_[channel].match;
  digest.mismatch = channels_[channel].mismatch;
  digest.excited = channels_[channel].excited;
  digest.verdict = to_string(status.verdict);
  digest.reason = to_string(status.reason);
  if (status.confounder >= 0)
    digest.confounder = mover_tags_[static_cast<std::size_t>(status.confounder)];
  digest.alarm = to_string(alarms_[channel]);
  digest.smallest_error = rounded(status.smallest_error);
  digest.effective_samples = rounded(status.effective_samples);
  if (status.verdict == Verdict::kUndetermined || (head.modelled && status.model_gain == 0.0))
    return digest;
  const double unit = head.modelled ? 100.0 / status.model_gain : 1.0;
  const double a = unit * status.effect_low, b = unit * status.effect_high;
  if (head.modelled && !(std::abs(b - a) <= kWidestInterval)) return digest;
  digest.gain_error = rounded(unit * status.effect_size);
  digest.low = rounded(std::min(a, b));
  digest.high = rounded(std::max(a, b));
  return digest;
}

std::optional<Digest> DigestMaker::finish() {
  if (samples_ == 0) return std::nullopt;
  Digest digest;
  digest.from_ns = from_ns_;
  digest.until_ns = until_ns_;
  digest.samples = samples_;
  for (std::size_t j = 0; j < cvs_.size(); ++j) {
    const Cv& cv = cvs_[j];
    digest.cvs.push_back({head_.cvs[j].cv, cv.known, rms(cv.residual_square, cv.known),
                          cv.predictions.pairs, rounded(cv.predictions.rmse()),
                          rounded(cv.predictions.movement_rms())});
  }
  for (std::size_t c = 0; c < channels_.size(); ++c) digest.channels.push_back(digest_of(c));
  samples_ = 0;
  std::fill(cvs_.begin(), cvs_.end(), Cv());
  std::fill(channels_.begin(), channels_.end(), Channel());
  return digest;
}

}  // namespace mpm::history
