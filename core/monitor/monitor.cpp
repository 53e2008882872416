#include "core/monitor/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mismatch/channel_test.hpp"
#include "core/mismatch/lagged_correlation.hpp"
#include "core/mismatch/mean_line.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

// s.d. that the smallest visible error must exceed: root of the noncentrality at which a test of
// 6 degrees of freedom at level 0.0011 has 95 % power.
constexpr double kVisible = 5.8;

// Where the excitation is too poor to trust the calibration, only overwhelming evidence counts
// (times the usual rate), and none at all where even an error of this many gains would not show.
constexpr double kOverwhelming = 1e-6;
constexpr double kBlind = 100.0;

// Different degrees of freedom that channels' tests can have; room for them is made up front.
constexpr std::size_t kMostTests = 32;

}  // namespace

struct Monitor::State {
  State(const ModelSpec& spec, const SignalCounts& signal_counts,
        const std::vector<bool>& predictions, const MonitorSettings& monitor_settings,
        const AlarmSettings& alarm_settings)
      : counts(signal_counts),
        model(spec),
        has_prediction(predictions),
        settings(derive_settings(spec, model, monitor_settings, alarm_settings)),
        inputs(Eigen::VectorXd::Zero(signal_counts.inputs())),
        residuals(Eigen::VectorXd::Zero(signal_counts.cv)),
        correlation({signal_counts.inputs(), signal_counts.cv, settings.controlling_lags,
                     settings.first_lag, settings.last_lag, settings.correlation},
                    settings.lambda),
        test({signal_counts.inputs(), signal_counts.cv, settings.fir_lags, settings.residual_order,
              settings.tail_poles},
             settings.lambda, model) {
    const auto channels = static_cast<std::size_t>(counts.inputs() * counts.cv);
    status.resize(channels);
    conditions.resize(channels);
    transitions.reserve(channels);
    thresholds.reserve(kMostTests);
    simulates =
        std::find(has_prediction.begin(), has_prediction.end(), false) != has_prediction.end();
  }

  [[nodiscard]] std::size_t index(int cv, int input) const {
    return static_cast<std::size_t>(input * counts.cv + cv);
  }

  [[nodiscard]] bool read_inputs(const Frame& frame);
  [[nodiscard]] bool read_residuals(const Frame& frame);
  void simulate(bool inputs_usable);
  void judge();
  void judge_channel(int cv, int input, double channel_rate);
  double threshold_for(const ChannelEvidence& evidence, double channel_rate);
  void find_peak(int cv, int input, ChannelStatus& channel) const;
  void update_alarms();

  SignalCounts counts;
  LinearModel model;
  std::vector<bool> has_prediction;
  DerivedSettings settings;
  bool simulates = false;
  bool model_started = false;
  std::int64_t settling = 0;  // samples until a simulated prediction has forgotten its start
  bool first = true;
  std::int64_t last_interval = 0;
  std::uint64_t unusable = 0;     // frames so far that lacked a value
  std::int64_t unusable_run = 0;  // of them, in a row up to now
  Eigen::VectorXd inputs;
  Eigen::VectorXd residuals;
  LaggedCorrelation correlation;
  ChannelTest test;
  std::vector<ChannelStatus> status;
  std::vector<Condition> conditions;
  std::vector<AlarmTransition> transitions;
  struct Threshold {
    double numerator;
    int tests;
    double denominator;
    double value;
  };
  double line = 0.0;                  // with ThresholdKind::kMeanLine
  std::vector<Threshold> thresholds;  // one per kind of test, refreshed with the denominator
  MonitorCounters counters;
};

bool Monitor::State::read_inputs(const Frame& frame) {
  bool usable = true;
  for (int i = 0; i < counts.inputs(); ++i) {
    const bool is_mv = i < counts.mv;
    const SignalBlock& block = frame[is_mv ? SignalKind::kMv : SignalKind::kDv];
    const int at = is_mv ? i : i - counts.mv;
    if (block.usable(at)) {
      inputs(i) = block.values(at);
    } else {  // keeps the last value, for the simulation
      usable = false;
      ++counters.bad_values;
    }
  }
  return usable;
}

bool Monitor::State::read_residuals(const Frame& frame) {
  const SignalBlock& measured = frame[SignalKind::kCv];
  const SignalBlock& predicted = frame[SignalKind::kPrediction];
  bool usable = true;
  for (int j = 0; j < counts.cv; ++j) {
    const bool given = has_prediction[static_cast<std::size_t>(j)];
    if (!measured.usable(j) || (given && !predicted.usable(j))) {
      usable = false;
      ++counters.bad_values;
      continue;
    }
    residuals(j) = measured.values(j) - (given ? predicted.values(j) : model.output()(j));
  }
  return usable;
}

void Monitor::State::simulate(bool inputs_usable) {
  if (!simulates) return;
  // Where the plant stood before the first sample is unknown: at rest with the first inputs is the
  // least wrong, and what is wrong about it has died out once the model has settled.
  if (!model_started && inputs_usable) {
    model.reset_steady(inputs);
    model_started = true;
    settling = settings.settling_samples;
  } else if (!inputs_usable) {
    settling = settings.settling_samples;
  } else if (settling > 0) {
    --settling;
  }
  if (model_started) model.advance(inputs);
}

Monitor::Monitor(const ModelSpec& model, const SignalCounts& counts,
                 const std::vector<bool>& has_prediction, const MonitorSettings& settings,
                 const AlarmSettings& alarms)
    : state_(std::make_unique<State>(model, counts, has_prediction, settings, alarms)) {}
Monitor::Monitor(Monitor&&) noexcept = default;
Monitor& Monitor::operator=(Monitor&&) noexcept = default;
Monitor::~Monitor() = default;

void Monitor::push(const Frame& frame) {
  State& s = *state_;
  s.transitions.clear();
  ++s.counters.frames;
  if (!s.first && frame.interval <= s.last_interval) {
    ++s.counters.out_of_order;
    return;
  }
  const std::int64_t missing = s.first ? 0 : frame.interval - s.last_interval - 1;
  s.first = false;
  s.last_interval = frame.interval;
  if (missing > 0) {
    s.counters.missing += static_cast<std::uint64_t>(missing);
    s.correlation.close_window();
    s.test.skip(missing);
    if (s.simulates && s.model_started) {
      for (std::int64_t k = 0; k < std::min<std::int64_t>(missing, s.settings.settling_samples);
           ++k)
        s.model.advance(s.inputs);
      s.settling = s.settings.settling_samples;
    }
  }

  const bool inputs_usable = s.read_inputs(frame);
  const bool residuals_usable = s.read_residuals(frame);
  const bool settled = !s.simulates || (s.model_started && s.settling == 0);
  s.simulate(inputs_usable);
  const bool usable = inputs_usable && residuals_usable;
  s.unusable += usable ? 0 : 1;
  s.unusable_run = usable ? 0 : s.unusable_run + 1;
  if (usable && settled) {
    s.correlation.update(s.inputs, s.residuals);
    if (s.test.update(s.inputs, s.residuals)) ++s.counters.used;
    s.correlation.evaluate();
    s.test.evaluate();
  } else {
    s.correlation.close_window();
    s.test.skip(1);
  }
  s.judge();
  s.update_alarms();
}

void Monitor::State::judge() {
  const double channel_rate = settings.false_alarm_rate / (counts.inputs() * counts.cv);
  if (settings.threshold == ThresholdKind::kMeanLine) line = mean_line(correlation);
  for (int i = 0; i < counts.inputs(); ++i)
    for (int j = 0; j < counts.cv; ++j) judge_channel(j, i, channel_rate);
}

void Monitor::State::judge_channel(int cv, int input, double channel_rate) {
  ChannelStatus& channel = status[index(cv, input)];
  channel.effective_samples = test.effective_rows();
  channel.confounder = -1;
  find_peak(cv, input, channel);

  channel.verdict = Verdict::kUndetermined;
  if (unusable_run > settings.fir_lags || 2 * unusable > counters.frames) {
    channel.reason = Reason::kBadData;
    return;
  }
  if (!test.ready()) {
    channel.reason = Reason::kWarmingUp;
    return;
  }
  const ChannelEvidence& evidence = test.evidence(cv, input);
  channel.p_value = evidence.p_value;
  channel.statistic = evidence.statistic;
  channel.threshold = threshold_for(evidence, channel_rate);
  bool exceeds = evidence.p_value < channel_rate;
  if (settings.threshold == ThresholdKind::kMeanLine) {
    channel.statistic = std::abs(channel.partial_correlation);
    channel.threshold = line;
    exceeds = channel.statistic > channel.threshold;
  }
  channel.effect_size = evidence.gain_error_ratio * evidence.reference_gain;
  channel.smallest_error = std::min(kVisible * evidence.excitation_index, kBlind);
  channel.excited = channel.smallest_error <= settings.gain_error_of_interest;
  const bool overwhelming =
      channel.smallest_error < kBlind && evidence.p_value < kOverwhelming * channel_rate;
  if (channel.excited || (overwhelming && exceeds)) {
    channel.verdict = exceeds ? Verdict::kMismatch : Verdict::kMatch;
    channel.reason = Reason::kNone;
  } else if (kVisible * evidence.excitation_index_alone <= settings.gain_error_of_interest &&
             evidence.confounder >= 0) {
    channel.reason = Reason::kCollinear;
    channel.confounder = evidence.confounder;
  } else {
    channel.reason = Reason::kNotExcited;
  }
}

// F at which that evidence would be a mismatch. The quantile takes a search, so it is kept until
// the degrees of freedom have changed by one per cent, which moves it by some 1e-5.
double Monitor::State::threshold_for(const ChannelEvidence& evidence, double channel_rate) {
  if (evidence.numerator_freedom <= 0.0) return 0.0;
  const double freedom = test.denominator_freedom();
  for (Threshold& known : thresholds) {
    if (known.numerator != evidence.numerator_freedom || known.tests != evidence.tests) continue;
    if (std::abs(known.denominator - freedom) > 0.01 * freedom) {
      known.denominator = freedom;
      known.value = f_quantile(channel_rate / known.tests, known.numerator, freedom);
    }
    return known.value;
  }
  const Threshold added{
      evidence.numerator_freedom, evidence.tests, freedom,
      f_quantile(channel_rate / evidence.tests, evidence.numerator_freedom, freedom)};
  thresholds.push_back(added);
  return added.value;
}

// The largest partial correlation at the lags that feedback does not reach.
void Monitor::State::find_peak(int cv, int input, ChannelStatus& channel) const {
  const Eigen::Ref<const Eigen::VectorXd> values = correlation.correlations(cv, input);
  channel.partial_correlation = 0.0;
  channel.lag = 0;
  for (int d = std::max(1, settings.first_lag); d <= settings.last_lag; ++d) {
    const double value = values(d - settings.first_lag);
    if (std::abs(value) > std::abs(channel.partial_correlation)) {
      channel.partial_correlation = value;
      channel.lag = d;
    }
  }
}

void Monitor::State::update_alarms() {
  for (int i = 0; i < counts.inputs(); ++i) {
    for (int j = 0; j < counts.cv; ++j) {
      const ChannelStatus& channel = status[index(j, i)];
      Condition& condition = conditions[index(j, i)];
      if (channel.verdict == Verdict::kUndetermined)
        condition.hold();
      else if (condition.update(channel.p_value, settings.alarm))
        transitions.push_back({j, i, condition.state()});
    }
  }
}

const ChannelStatus& Monitor::channel(int cv, int input) const {
  return state_->status[state_->index(cv, input)];
}
AlarmState Monitor::alarm(int cv, int input) const {
  return state_->conditions[state_->index(cv, input)].state();
}
Eigen::Ref<const Eigen::VectorXd> Monitor::partial_correlations(int cv, int input) const {
  return state_->correlation.correlations(cv, input);
}
int Monitor::first_lag() const { return state_->settings.first_lag; }
int Monitor::last_lag() const { return state_->settings.last_lag; }
const std::vector<AlarmTransition>& Monitor::transitions() const { return state_->transitions; }
const MonitorCounters& Monitor::counters() const { return state_->counters; }

}  // namespace mpm
