#include "tests/daemon/live/interrupted_unit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/model/linear_model.hpp"
#include "daemon/files/aligning.hpp"
#include "daemon/report/record_json.hpp"
#include "daemon/report/unit_performance.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::uint64_t stream(const Ordeal& ordeal, int purpose, int index) {
  return 1000 * ordeal.seed + 50 * static_cast<std::uint64_t>(purpose) +
         static_cast<std::uint64_t>(index);
}

// 0 .. 1, of whatever happens now and then.
double chance(const Ordeal& ordeal, int purpose, int index, int sample) {
  return 0.5 + 0.5 * uniform(stream(ordeal, purpose, index), sample);
}

void spoil(const Ordeal& ordeal, int sample, Frame& frame) {
  int signal = 0;
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv, SignalKind::kPrediction,
        SignalKind::kSetpoint, SignalKind::kAux, SignalKind::kRaw}) {
    SignalBlock& block = frame[kind];
    for (int i = 0; i < block.size(); ++i, ++signal) {
      const double dice = chance(ordeal, 5, signal, sample);
      Quality& quality = block.quality[static_cast<std::size_t>(i)];
      if (dice < 0.002) block.values(i) = kUnknown;
      if (dice > 0.002 && dice < 0.004) quality = Quality::kBad;
      if (dice > 0.004 && dice < 0.005) block.values(i) += 40.0;
      if (dice > 0.005 && dice < 0.008 && kind == SignalKind::kCv) block.values(i) += 1.5;
      if (sample % 600 > 560 && sample % 600 < 575 && sample / 600 % 2 == i % 2 &&
          (kind == SignalKind::kCv || kind == SignalKind::kPrediction))
        block.values(i) = 0.125;
      // One signal after the other is lost for a while, and one goes where no process does.
      if (sample % 400 > 330 && sample / 400 % 7 == signal % 7) quality = Quality::kBad;
      if (sample % 700 > 690 && sample / 700 % 3 == signal % 3) block.values(i) = 1e5 + dice;
    }
  }
}

void note(std::string& out, double number) {
  char bits[sizeof number];
  std::memcpy(bits, &number, sizeof number);
  out.append(bits, sizeof number);
}

std::array<bool, kSignalKindCount> needed(const config::UnitConfig& config) {
  return files::needed_kinds(config);
}

}  // namespace

std::vector<Frame> frames_of(const Ordeal& ordeal) {
  const config::UnitConfig& config = ordeal.config;
  ModelSpec changed = config.model;
  if (!changed.channels.empty())
    if (auto* transfer = std::get_if<TransferFunction>(&changed.channels[0].dynamics))
      transfer->gain *= 1.8;
  LinearModel as_is(config.model), otherwise(changed);
  const SignalCounts counts = config.counts();
  Eigen::VectorXd u = config.model.input_origin;
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(counts.cv);
  double reported = 0.0, aux = 0.0, aux_last = 0.0, aux_before = 0.0;
  std::vector<Frame> frames;
  for (int k = 0; k < ordeal.samples; ++k) {
    const bool rests = k >= ordeal.rest_from && k < ordeal.rest_until;
    for (int i = 0; i < counts.inputs() && !rests; ++i)
      u(i) = config.model.input_origin(i) + (k < 30 ? 0.01 * uniform(stream(ordeal, 0, i), k)
                                                    : uniform(stream(ordeal, 1, i), k / 17));
    aux_before = std::exchange(aux_last, aux);
    aux = 0.9 * aux + uniform(stream(ordeal, 2, 0), k);
    if (ordeal.follows > 0.0 && !rests) u(0) += 0.5 * aux;  // somebody acts on it by hand
    Frame frame(counts);
    frame.interval = k;
    frame.source_time_ns = k * static_cast<std::int64_t>(1e9 * config.sample_time_s);
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    const bool change = k >= ordeal.change_from && k < ordeal.change_until;
    Eigen::VectorXd y = change ? otherwise.output() : as_is.output();
    const Eigen::VectorXd predicted = as_is.output();
    if (counts.cv > 0) {
      const double away = predicted(0) - config.model.output_origin(0);
      y(0) += ordeal.bend * away * away + ordeal.follows * aux_before;
    }
    for (int j = 0; j < counts.cv; ++j) {
      noise(j) = 0.7 * noise(j) + 0.03 * uniform(stream(ordeal, 3, j), k);
      y(j) += noise(j);
    }
    double& last = y(counts.cv - 1);
    if (ordeal.quantum > 0.0) last = ordeal.quantum * std::round(last / ordeal.quantum);
    if (k < ordeal.held_until) {
      if (std::abs(last - reported) > 0.15) reported = last;
      last = reported;
    }
    frame[SignalKind::kMv].values = u.head(counts.mv);
    frame[SignalKind::kDv].values = u.tail(counts.dv);
    frame[SignalKind::kCv].values = y;
    for (int j = 0; j < counts.cv; ++j) {
      const bool comes = ordeal.predicted && (j > 0 || k >= ordeal.first_prediction) &&
                         (k < ordeal.none_from || k >= ordeal.none_until);
      frame[SignalKind::kPrediction].values(j) = comes ? predicted(j) : kUnknown;
      frame[SignalKind::kSetpoint].values(j) = uniform(stream(ordeal, 4, j), k / 60);
    }
    frame[SignalKind::kAux].values.setConstant(aux);
    for (int r = 0; r < counts.raw; ++r)
      frame[SignalKind::kRaw].values(r) = y(0) + uniform(stream(ordeal, 6, r), k);
    if (ordeal.troubles) spoil(ordeal, k, frame);
    frames.push_back(frame);
    as_is.advance(u);
    otherwise.advance(u);
  }
  return frames;
}

OneUnit::OneUnit(const config::UnitConfig& config)
    : config_(config),
      monitor_(config),
      performance_(report::performance_setup(config), 300.0),
      ring_(config.counts(), 250),
      schedule_({100, 60, 200, static_cast<std::int64_t>(90e9 * config.sample_time_s)}),
      calculator_(config),
      calculated_(config.counts()),
      aligner_(
          config.counts(), needed(config), [this](const Frame& frame) { on_frame(frame); },
          files::aligner_settings(config)) {}

void OneUnit::on_frame(const Frame& frame) {
  calculated_ = frame;
  calculated_[SignalKind::kAux] = (*sample_)[SignalKind::kAux];  // comes in files only
  calculator_.fill(calculated_);
  monitor_.push(calculated_);
  const Monitor& monitor = monitor_.monitor();
  if (performance_.push(calculated_, monitor.judged()))
    said_ += report::json_of(
                 report::performance_record(config_, performance_.setup(), performance_.total()))
                 .dump();
  ring_.push(calculated_);
  for (const AlarmRecord& alarm : monitor_.alarms()) said_ += report::json_of(alarm).dump();
  bool active = false;
  for (int i = 0; i < config_.counts().inputs(); ++i)
    for (int j = 0; j < config_.counts().cv; ++j) {
      const ChannelStatus& channel = monitor.channel(j, i);
      active = active || monitor.alarm(j, i) == AlarmState::kActive;
      for (const double number :
           {channel.p_value, channel.statistic, channel.threshold, channel.effect_size,
            channel.smallest_error, channel.effective_samples, channel.partial_correlation})
        note(said_, number);
      said_ += report::json_of(monitor.nonlinearity(j, i)).dump();
    }
  said_ += schedule_.due(frame.source_time_ns, ring_.rows(), !monitor_.alarms().empty(), active)
               ? "due"
               : "";
  if (monitor_.interval() % 37 == 0) said_ += all();
}

void OneUnit::take(const Ordeal& ordeal, const std::vector<Frame>& frames, int sample) {
  const auto push = [&](SignalKind kind, int at) {
    const Frame& frame = frames[static_cast<std::size_t>(at)];
    const SignalBlock& block = frame[kind];
    if (block.size() == 0) return;
    std::vector<std::uint8_t> quality;
    for (const Quality each : block.quality) quality.push_back(static_cast<std::uint8_t>(each));
    // The controller restarts and counts anew; the times go on.
    const bool anew = ordeal.shuffled && at >= ordeal.samples / 2;
    aligner_.push({kind,
                   anew ? at - ordeal.samples / 2 + 3 : frame.interval,
                   frame.source_time_ns,
                   {block.values.data(), static_cast<std::size_t>(block.size())},
                   quality});
  };
  sample_ = &frames[static_cast<std::size_t>(sample)];
  const bool gap =
      ordeal.troubles && (sample % 211 == 77 || (sample % 500 > 470 && sample % 500 < 479) ||
                          (sample > 1200 && sample < 1230));
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                SignalKind::kSetpoint, SignalKind::kRaw, SignalKind::kPrediction}) {
    if (gap) continue;
    if (!ordeal.shuffled) {
      push(kind, sample);
      continue;
    }
    const double dice = chance(ordeal, 7, static_cast<int>(kind), sample);
    const bool was_late = sample > 0 && chance(ordeal, 7, static_cast<int>(kind), sample - 1) < 0.1;
    if (dice >= 0.1) push(kind, sample);
    if (was_late) push(kind, sample - 1);
    if (dice > 0.97) push(kind, sample);
  }
  if (sample % 50 == 49) aligner_.expire();
}

std::vector<std::byte> OneUnit::put_away() const {
  return mpm::put_away(monitor_, performance_, ring_, schedule_, aligner_);
}

void OneUnit::take_back(std::span<const std::byte> bytes) {
  mpm::take_back(bytes, monitor_, performance_, ring_, schedule_, aligner_);
}

std::string OneUnit::all() {
  std::string out;
  for (const ChannelRecord& channel : monitor_.channels()) {
    out += report::json_of(channel).dump();
    for (const double value : channel.partial_correlations) note(out, value);
  }
  for (const AlarmRecord& alarm : monitor_.alarms()) out += report::json_of(alarm).dump();
  const Monitor& monitor = monitor_.monitor();
  for (int j = 0; j < config_.counts().cv; ++j) note(out, monitor.samples_needed(j));
  for (const LostSignal& lost : monitor.lost())
    out += std::to_string(static_cast<int>(lost.kind)) + std::to_string(lost.index) +
           std::to_string(static_cast<int>(lost.cause)) + std::to_string(lost.since_ns);
  for (const JudgedFrame& judged : monitor.judged()) {
    out += std::to_string(judged.interval);
    for (const CvReading& reading : judged.readings) {
      note(out, reading.measured);
      note(out, reading.residual);
    }
  }
  for (const AlarmTransition& transition : monitor.transitions())
    out += std::to_string(transition.cv) + std::to_string(transition.input);
  const MonitorCounters& counted = monitor.counters();
  for (const std::uint64_t count :
       {counted.frames, counted.used, counted.missing, counted.out_of_order, counted.bad_values,
        counted.implausible.frozen, counted.implausible.clipped, counted.implausible.spikes})
    out += std::to_string(count) + ' ';
  for (const auto& kind : counted.bad_of)
    for (const std::uint64_t count : kind) out += std::to_string(count) + ' ';
  out += report::json_of(
             report::performance_record(config_, performance_.setup(), performance_.total()))
             .dump();
  const live::RingCopy copy = ring_.copy();
  out += std::to_string(copy.last_interval) + ' ' + std::to_string(copy.last_time_ns);
  for (const double value : copy.values) note(out, value);
  const AlignerCounters& aligned = aligner_.counters();
  for (const std::uint64_t count :
       {aligned.frames, aligned.incomplete, aligned.missing, aligned.late, aligned.repeated,
        aligned.out_of_order, aligned.non_finite, aligned.infinite, aligned.restarts})
    out += std::to_string(count) + ' ';
  return out;
}

}  // namespace mpm::test
