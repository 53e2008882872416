#include "core/monitor/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mismatch/change_scan.hpp"
#include "core/mismatch/lagged_correlation.hpp"
#include "core/mismatch/mean_line.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/calibration.hpp"
#include "core/monitor/cv_alarms.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/input_motion.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

namespace visibility = calibration::visibility;
namespace bad_data = calibration::bad_data;

// Different degrees of freedom that channels' tests can have; room for them is made up front.
constexpr std::size_t kMostTests = 32;

constexpr double kShareStep = 1.0 / bad_data::kShareSamples;
constexpr double kImplausibleStep = 1.0 / bad_data::kImplausibleSamples;

std::vector<bool> channels_of(const LinearModel& model, const DerivedSettings& settings) {
  std::vector<bool> acts;
  const int length = settings.settling_samples + settings.fir_lags;
  for (int i = 0; i < model.input_count(); ++i)
    for (int j = 0; j < model.cv_count(); ++j)
      acts.push_back(model.impulse_response(j, i, length).cwiseAbs().maxCoeff() > 0.0);
  return acts;
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

struct Monitor::State {
  State(const ModelSpec& spec, const SignalCounts& signal_counts,
        const std::vector<bool>& predictions, const MonitorSettings& monitor_settings,
        const AlarmSettings& alarm_settings)
      : counts(signal_counts),
        model(spec),
        may_predict(predictions),
        settings(derive_settings(spec, model, monitor_settings, alarm_settings)),
        inputs(Eigen::VectorXd::Zero(signal_counts.inputs())),
        held_inputs(Eigen::VectorXd::Zero(signal_counts.inputs())),
        residuals(Eigen::VectorXd::Zero(signal_counts.cv)),
        held_residuals(Eigen::VectorXd::Zero(signal_counts.cv)),
        acts(channels_of(model, settings)),
        screen(signal_counts, predictions, acts,
               static_cast<int>(std::ceil(model.longest_dead_time_samples()))),
        correlation({signal_counts.inputs(), signal_counts.cv, settings.controlling_lags,
                     settings.first_lag, settings.last_lag, settings.correlation},
                    settings.lambda),
        detector({signal_counts.inputs(), signal_counts.cv, settings.fir_lags,
                  settings.residual_order, settings.tail_poles},
                 settings.memories, settings.remembered, settings.evaluation_stride, model,
                 settings.materiality),
        scan(detector.shape()) {
    const auto channels = static_cast<std::size_t>(counts.inputs() * counts.cv);
    status.resize(channels);
    transitions.reserve(channels);
    thresholds.reserve(kMostTests);
    for (int j = 0; j < counts.cv; ++j) cvs.emplace_back(counts.inputs());
    for (int i = 0; i < counts.inputs(); ++i) {
      motions.emplace_back(settings.remembered * calibration::input_motion::kMemoryShare);
      unknown_runs.push_back(0);
    }
    has_model = std::find(acts.begin(), acts.end(), true) != acts.end();
  }

  /// One CV: whether its data serve, and its alarms.
  struct Cv {
    explicit Cv(int input_count) : alarms(input_count) {}
    CvAlarms alarms;
    std::int64_t settling = 0;     // samples until its simulated prediction can be trusted
    std::int64_t unknown_run = 0;  // residuals unknown in a row up to now
    std::int64_t without_row = 0;  // samples in a row
    double bad_share = 0.0;
    double implausible_share = 0.0;
    double spike_share = 0.0;
    std::uint64_t spikes = 0;
    bool predicted = false;  // by what came with the frames; else simulated
    bool evaluated = false;  // in this sample
    bool judged = false;     // there is evidence from the present memory
  };

  [[nodiscard]] std::size_t index(int cv, int input) const {
    return static_cast<std::size_t>(input * counts.cv + cv);
  }
  [[nodiscard]] Cv& of(int cv) { return cvs[static_cast<std::size_t>(cv)]; }

  void take_frame(const Frame& frame);
  void pass_gap(std::int64_t missing);
  void follow_predictions();
  void read_inputs(const Frame& frame);
  void read_residuals(const Frame& frame);
  void distrust_simulation(int input);
  void simulate();
  void take_sample();
  [[nodiscard]] bool implausible(int cv) const {
    const Cv& state = cvs[static_cast<std::size_t>(cv)];
    return state.implausible_share > bad_data::kImplausibleShare ||
           state.spike_share > bad_data::kSpikyShare;
  }
  void evaluate();
  void judge();
  void judge_channel(int cv, int input, double channel_rate);
  [[nodiscard]] Reason why_not_excited(int cv, int input);
  double threshold_for(const ChannelEvidence& evidence, double freedom, double channel_rate);
  void find_peak(int cv, int input, ChannelStatus& channel) const;
  void correlate();

  SignalCounts counts;
  LinearModel model;
  std::vector<bool> may_predict;
  DerivedSettings settings;
  bool has_model = false;
  bool simulates = true;  // some CV
  bool model_started = false;
  bool first = true;
  std::int64_t last_interval = 0;   // pushed
  std::int64_t taken_interval = 0;  // left the screen
  std::int64_t samples = 0;
  Eigen::VectorXd inputs;       // NaN where unknown
  Eigen::VectorXd held_inputs;  // the last known values
  Eigen::VectorXd residuals;
  Eigen::VectorXd held_residuals;
  std::vector<bool> acts;  // per channel, input-major: the model has it
  Screen screen;
  std::vector<std::int64_t> unknown_runs;  // per input
  std::vector<InputMotion> motions;        // per input
  LaggedCorrelation correlation;
  bool correlated = false;  // correlations and their peaks know the last sample
  MismatchDetector detector;
  ChangeScan scan;
  std::vector<Cv> cvs;
  std::vector<ChannelStatus> status;
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

// Where the control system says what its model predicts, no simulation of ours is asked.
void Monitor::State::follow_predictions() {
  simulates = false;
  for (int j = 0; j < counts.cv; ++j) {
    Cv& cv = of(j);
    if (!cv.predicted && screen.predicted(j)) {
      cv.predicted = true;
      cv.settling = 0;
      if (samples > 0) detector.start_afresh(j, 0);
    }
    // Without any model only the control system can predict.
    simulates =
        simulates || (!cv.predicted && (has_model || !may_predict[static_cast<std::size_t>(j)]));
  }
}

void Monitor::State::read_inputs(const Frame& frame) {
  for (int i = 0; i < counts.inputs(); ++i) {
    const bool is_mv = i < counts.mv;
    const SignalBlock& block = frame[is_mv ? SignalKind::kMv : SignalKind::kDv];
    const int at = is_mv ? i : i - counts.mv;
    std::int64_t& run = unknown_runs[static_cast<std::size_t>(i)];
    if (block.usable(at)) {
      inputs(i) = held_inputs(i) = block.values(at);
      motions[static_cast<std::size_t>(i)].take(inputs(i));
      run = 0;
    } else {
      inputs(i) = kUnknown;
      ++counters.bad_values;
      if (++run > bad_data::kHeldSamples) distrust_simulation(i);
    }
  }
}

// An input that was unknown for long moved unseen: what is simulated from it is wrong until it has
// forgotten that.
void Monitor::State::distrust_simulation(int input) {
  for (int j = 0; j < counts.cv; ++j)
    if (!of(j).predicted && acts[index(j, input)]) of(j).settling = settings.settling_samples;
}

void Monitor::State::read_residuals(const Frame& frame) {
  const SignalBlock& measured = frame[SignalKind::kCv];
  const SignalBlock& predicted = frame[SignalKind::kPrediction];
  for (int j = 0; j < counts.cv; ++j) {
    Cv& cv = of(j);
    const bool given = cv.predicted;
    const auto at = static_cast<std::size_t>(j);
    const bool implausible = measured.quality[at] == Quality::kImplausible ||
                             (given && predicted.quality[at] == Quality::kImplausible);
    cv.implausible_share += kImplausibleStep * ((implausible ? 1.0 : 0.0) - cv.implausible_share);
    residuals(j) = kUnknown;
    const bool measures = measured.usable(j), predicts = !given || predicted.usable(j);
    counters.bad_values += (measures ? 0 : 1) + (predicts ? 0 : 1);
    if (!measures || !predicts) {
      // no residual
    } else if (given) {
      residuals(j) = measured.values(j) - predicted.values(j);
    } else if (model_started && cv.settling == 0) {
      residuals(j) = measured.values(j) - model.output()(j);
    }
    if (std::isfinite(residuals(j))) {
      held_residuals(j) = residuals(j);
      cv.unknown_run = 0;
    } else {
      ++cv.unknown_run;
    }
    if (cv.settling > 0) --cv.settling;
  }
}

void Monitor::State::simulate() {
  if (!simulates) return;
  // Where the plant stood before the first sample is unknown: at rest with the first inputs is the
  // least wrong, and what is wrong about it has died out once the model has settled.
  if (!model_started) {
    if (!inputs.allFinite()) return;
    model.reset_steady(inputs);
    model_started = true;
    for (Cv& cv : cvs) cv.settling = settings.settling_samples;
  }
  model.advance(held_inputs);
}

void Monitor::State::pass_gap(std::int64_t missing) {
  counters.missing += static_cast<std::uint64_t>(missing);
  correlation.close_window();
  detector.skip(missing);
  for (Cv& cv : cvs) cv.unknown_run += missing;
  if (!model_started) return;
  for (std::int64_t k = 0; k < std::min<std::int64_t>(missing, settings.settling_samples); ++k)
    model.advance(held_inputs);
  if (missing > bad_data::kHeldSamples)
    for (int i = 0; i < counts.inputs(); ++i) distrust_simulation(i);
}

void Monitor::State::take_sample() {
  ++samples;
  detector.update(inputs, residuals);
  bool used = false;
  for (int j = 0; j < counts.cv; ++j) {
    Cv& cv = of(j);
    const bool took = detector.took_row(j);
    used = used || took;
    cv.without_row = took ? 0 : cv.without_row + 1;
    const double spiked = screen.spikes(j) > cv.spikes ? 1.0 : 0.0;
    cv.spikes = screen.spikes(j);
    cv.spike_share +=
        std::max(kImplausibleStep, 1.0 / static_cast<double>(samples)) * (spiked - cv.spike_share);
    cv.bad_share += kShareStep * ((std::isfinite(residuals(j)) ? 0.0 : 1.0) - cv.bad_share);
  }
  if (used) ++counters.used;

  const bool close =
      std::all_of(cvs.begin(), cvs.end(),
                  [](const Cv& cv) { return cv.unknown_run <= bad_data::kHeldSamples; }) &&
      std::all_of(unknown_runs.begin(), unknown_runs.end(),
                  [](std::int64_t run) { return run <= bad_data::kHeldSamples; });
  if (close)
    correlation.update(held_inputs, held_residuals);
  else
    correlation.close_window();
}

// Of each CV every so many samples, one CV after the other.
void Monitor::State::evaluate() {
  const std::int64_t stride = settings.evaluation_stride;
  for (int j = 0; j < counts.cv; ++j) {
    Cv& cv = of(j);
    const bool due = (samples + j * stride / counts.cv) % stride == 0;
    if (due) detector.fold(j);
    if (cv.alarms.isolating() || !detector.memory(j).ready()) cv.judged = false;
    cv.evaluated = (due || !cv.judged) && detector.memory(j).ready();
    if (!cv.evaluated) continue;
    cv.judged = true;
    for (int m = 0; m < detector.memory_count(); ++m)
      if (detector.memory(j, m).ready()) detector.evaluate(j, m);
  }
}

Monitor::Monitor(const ModelSpec& model, const SignalCounts& counts,
                 const std::vector<bool>& may_predict, const MonitorSettings& settings,
                 const AlarmSettings& alarms)
    : state_(std::make_unique<State>(model, counts, may_predict, settings, alarms)) {}
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
  s.first = false;
  s.last_interval = frame.interval;
  const Frame* screened = s.screen.push(frame);
  s.counters.implausible = s.screen.counters();
  if (screened != nullptr) s.take_frame(*screened);
}

void Monitor::State::take_frame(const Frame& frame) {
  const std::int64_t missing = samples == 0 ? 0 : frame.interval - taken_interval - 1;
  taken_interval = frame.interval;
  if (missing > 0) pass_gap(missing);
  if (simulates) follow_predictions();
  // Anew with each frame: what disturbs in the model keeps to the clock of the data over gaps.
  if (simulates) model.set_time_s(1e-9 * static_cast<double>(frame.source_time_ns));
  read_inputs(frame);
  read_residuals(frame);
  simulate();
  take_sample();
  evaluate();
  for (int j = 0; j < counts.cv; ++j) {
    if (implausible(j)) {
      of(j).alarms.hold();
      continue;
    }
    of(j).alarms.update(j, of(j).evaluated, detector, scan, settings.alarm, [&](int input) {
      transitions.push_back({j, input, of(j).alarms.state(input)});
    });
  }
  judge();
}

void Monitor::State::judge() {
  const double channel_rate = settings.false_alarm_rate / (counts.inputs() * counts.cv);
  correlated = false;
  if (settings.threshold == ThresholdKind::kMeanLine) {
    correlation.evaluate();
    line = mean_line(correlation);
  }
  for (int i = 0; i < counts.inputs(); ++i)
    for (int j = 0; j < counts.cv; ++j) judge_channel(j, i, channel_rate);
}

void Monitor::State::judge_channel(int cv, int input, double channel_rate) {
  ChannelStatus& channel = status[index(cv, input)];
  const RegressionMemory& memory = detector.memory(cv);
  const CvAlarms& alarms = of(cv).alarms;
  channel.effective_samples = memory.effective_rows();
  channel.confounder = -1;

  channel.verdict = Verdict::kUndetermined;
  const bool outage = of(cv).without_row > settings.fir_lags &&
                      of(cv).unknown_run > settings.fir_lags && of(cv).settling == 0;
  const bool input_lost = unknown_runs[static_cast<std::size_t>(input)] > settings.fir_lags;
  if (outage || input_lost || of(cv).bad_share > bad_data::kMostShare || implausible(cv)) {
    channel.reason = Reason::kBadData;
    return;
  }
  if (!memory.ready() || alarms.isolating()) {
    const double effective_samples = channel.effective_samples;
    channel = ChannelStatus{};  // what was known before says nothing now
    channel.effective_samples = effective_samples;
    if (alarms.isolating() && alarms.state(input) == AlarmState::kActive)
      channel.p_value = alarms.change_p_value();
    const bool bad = static_cast<double>(samples) >= bad_data::kWarmUps * memory.needed_rows() &&
                     !alarms.isolating();
    channel.reason = alarms.isolating() ? Reason::kIsolating
                     : bad              ? Reason::kBadData
                                        : Reason::kWarmingUp;
    return;
  }
  const ChannelEvidence& evidence = detector.evidence(cv, input);
  channel.p_value = evidence.p_value;
  channel.p_value_material = evidence.p_value_material;
  channel.statistic = evidence.statistic;
  channel.threshold = threshold_for(evidence, memory.freedom(), channel_rate);
  const bool alarmed = alarms.state(input) == AlarmState::kActive;
  bool exceeds = evidence.p_value < channel_rate || alarmed;
  if (settings.threshold == ThresholdKind::kMeanLine) {
    find_peak(cv, input, channel);
    channel.statistic = std::abs(channel.partial_correlation);
    channel.threshold = line;
    exceeds = channel.statistic > channel.threshold;
  }
  channel.model_gain = evidence.reference_gain;
  channel.usual = evidence.usual;
  channel.log_time_error = evidence.log_time_error;
  channel.dead_time_error = evidence.dead_time_error;
  const double half =
      kNormalTwoSided95 * std::min(evidence.gain_error.deviation, visibility::kBlindGainError);
  channel.effect_size = evidence.gain_error.value * evidence.reference_gain;
  channel.effect_low = channel.effect_size - half * std::abs(evidence.reference_gain);
  channel.effect_high = channel.effect_size + half * std::abs(evidence.reference_gain);
  channel.smallest_error = std::min(visibility::kSeenDeviations * evidence.excitation_index,
                                    visibility::kBlindGainError);
  channel.excited = channel.smallest_error <= settings.gain_error_of_interest;
  channel.material = alarmed || evidence.p_value_material < channel_rate;
  const bool overwhelming = channel.smallest_error < visibility::kBlindGainError &&
                            evidence.p_value < visibility::kOverwhelming * channel_rate;
  if (channel.excited || ((overwhelming || alarmed) && exceeds)) {
    channel.verdict = exceeds ? Verdict::kMismatch : Verdict::kMatch;
    channel.reason = Reason::kNone;
    return;
  }
  channel.reason = why_not_excited(cv, input);
  if (channel.reason == Reason::kCollinear) channel.confounder = evidence.confounder;
}

Reason Monitor::State::why_not_excited(int cv, int input) {
  const ChannelEvidence& evidence = detector.evidence(cv, input);
  const bool all_still = std::all_of(motions.begin(), motions.begin() + counts.mv,
                                     [](const InputMotion& motion) { return motion.still(); });
  if (all_still && input < counts.mv) return Reason::kControllerOff;
  if (visibility::kSeenDeviations * evidence.excitation_index_alone <=
          settings.gain_error_of_interest &&
      evidence.confounder >= 0)
    return Reason::kCollinear;
  if (motions[static_cast<std::size_t>(input)].at_limit()) return Reason::kConstrained;
  return Reason::kNotExcited;
}

// F at which that evidence would be a mismatch. The quantile takes a search, so it is kept until
// the degrees of freedom have changed a little.
double Monitor::State::threshold_for(const ChannelEvidence& evidence, double freedom,
                                     double channel_rate) {
  if (evidence.numerator_freedom <= 0.0) return 0.0;
  for (Threshold& known : thresholds) {
    if (known.numerator != evidence.numerator_freedom || known.tests != evidence.tests) continue;
    if (std::abs(known.denominator - freedom) >
        calibration::evaluation::kKeptThresholdShare * freedom) {
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

// Only once somebody asks: rows that wait for each other cost a fraction.
void Monitor::State::correlate() {
  if (correlated) return;
  correlation.evaluate();
  for (int i = 0; i < counts.inputs(); ++i)
    for (int j = 0; j < counts.cv; ++j) find_peak(j, i, status[index(j, i)]);
  correlated = true;
}

const ChannelStatus& Monitor::channel(int cv, int input) const {
  state_->correlate();
  return state_->status[state_->index(cv, input)];
}
AlarmState Monitor::alarm(int cv, int input) const { return state_->of(cv).alarms.state(input); }
Eigen::Ref<const Eigen::VectorXd> Monitor::partial_correlations(int cv, int input) const {
  state_->correlate();
  return state_->correlation.correlations(cv, input);
}
int Monitor::first_lag() const { return state_->settings.first_lag; }
int Monitor::last_lag() const { return state_->settings.last_lag; }
const std::vector<AlarmTransition>& Monitor::transitions() const { return state_->transitions; }
const MonitorCounters& Monitor::counters() const { return state_->counters; }

}  // namespace mpm
