#include "core/monitor/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/mismatch/change_scan.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/mismatch/outside_signals.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/calibration.hpp"
#include "core/monitor/channel_judge.hpp"
#include "core/monitor/cv_alarms.hpp"
#include "core/monitor/cv_quality.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/held_inputs.hpp"
#include "core/monitor/reported_correlation.hpp"
#include "core/monitor/seldom_cvs.hpp"
#include "core/monitor/unit_reader.hpp"
#include "core/nonlinear/nonlinear_detector.hpp"

namespace mpm {

struct Monitor::State {
  State(const LinearModel& unit_model, const SignalCounts& signal_counts,
        const std::vector<bool>& may_predict, const DerivedSettings& derived,
        std::optional<SeldomCvs> seldom_cvs);

  void archive(Archive& a);
  /// As after construction, but for the alarms, which stay until new samples say something of
  /// them, and for what the data themselves look like.
  void begin_anew();
  /// One CV: what was learnt of it says nothing of what follows.
  void begin_anew(int cv);

  /// One CV: whether its data serve, and its alarms.
  struct Cv {
    Cv(int input_count, double shown_index) : alarms(input_count, shown_index) {}
    CvAlarms alarms;
    CvQuality quality;
    bool evaluated = false;    // in this sample
    bool judged = false;       // there is evidence from the present memory
    bool compressed = false;   // its values, or an input's from which it is simulated
    std::int64_t settled = 0;  // samples
    RivalSignal rival;
    std::int64_t followed_next = 0;  // sample
    void archive(Archive& a);
  };

  [[nodiscard]] std::size_t index(int cv, int input) const {
    return static_cast<std::size_t>(input * counts.cv + cv);
  }
  [[nodiscard]] Cv& of(int cv) { return cvs[static_cast<std::size_t>(cv)]; }

  void take_frame(const Frame& frame);
  void count_bad(const Frame& frame);
  void follow_compression();
  void take_outside(const Frame& frame);
  void take_seldom(const Frame& frame);
  void stand_at_readings(int cv);
  [[nodiscard]] const Monitor* at_readings(int cv) const {
    return seldom ? seldom->monitor(cv) : nullptr;
  }
  void pass_gap(std::int64_t missing);
  void take_sample(const Frame& frame);
  void evaluate();
  void follow(int cv);
  [[nodiscard]] bool is_unlike_errors(int cv) const;
  void move_alarms();
  void judge_channels();
  [[nodiscard]] Belief belief(int cv) const;
  void judge_nonlinear(int cv);
  [[nodiscard]] double gain_variation(int cv, int input) const;
  [[nodiscard]] bool bends(int cv, int input) const;
  [[nodiscard]] Reason bad_data(int cv, int input) const;
  [[nodiscard]] int spoilt_input(int cv, int input) const;
  [[nodiscard]] int missing_input(int cv, int input) const;
  [[nodiscard]] int held_input(int cv) const;
  [[nodiscard]] const NoiseLevel& noise_of(int cv) const;

  LinearModel model;
  SignalCounts counts;
  std::vector<bool> expected;  // per CV: a prediction may come
  DerivedSettings settings;
  UnitReader reader;
  HeldInputs held;
  ReportedCorrelation correlation;
  MismatchDetector detector;
  NonlinearDetector nonlinear;
  OutsideSignals outside;
  Eigen::VectorXd rows;            // residuals, NaN where no row may have them
  Eigen::VectorXd outside_values;  // set-points, then auxiliary signals; NaN where unknown
  ChangeScan scan;
  ChannelJudge judge;
  std::optional<SeldomCvs> seldom;  // none: all CVs are read at every sample
  std::vector<Cv> cvs;
  std::vector<ChannelStatus> status;
  std::vector<AlarmTransition> transitions;
  std::vector<JudgedFrame> judged_frames;  // room for all that may leave the screen at once
  std::size_t judged_count = 0;            // by the last push
  MonitorCounters counters;
  LostSignals lost;
  bool first = true;
  std::int64_t last_interval = 0;  // pushed
};

Monitor::State::State(const LinearModel& unit_model, const SignalCounts& signal_counts,
                      const std::vector<bool>& may_predict, const DerivedSettings& derived,
                      std::optional<SeldomCvs> seldom_cvs)
    : model(unit_model),
      counts(signal_counts),
      expected(may_predict),
      settings(derived),
      reader(model, counts, may_predict, settings),
      held(model),
      correlation(counts, settings),
      detector({counts.inputs(), counts.cv, settings.fir_lags, settings.residual_order,
                settings.tail_poles,
                simulates_some(may_predict) ? settings.start_poles : std::vector<double>{}, 0,
                settings.residual_poles},
               settings.memories, settings.remembered, settings.evaluation_stride, model,
               settings.materiality),
      nonlinear(detector.shape(), model,
                {settings.nonlinear, settings.memories.front(), settings.evaluation_stride,
                 settings.false_alarm_rate / (counts.inputs() * counts.cv),
                 settings.gain_error_of_interest}),
      outside(detector.shape(), counts.cv + counts.aux, settings.outside_poles,
              settings.remembered),
      rows(Eigen::VectorXd::Zero(counts.cv)),
      outside_values(Eigen::VectorXd::Zero(counts.cv + counts.aux)),
      scan(detector.shape()),
      judge(counts, settings),
      seldom(std::move(seldom_cvs)),
      lost(counts, settings.fir_lags) {
  const auto channels = static_cast<std::size_t>(counts.inputs() * counts.cv);
  status.resize(channels);
  judged_frames.resize(Screen::kHeld);
  for (JudgedFrame& one : judged_frames) one.readings.resize(static_cast<std::size_t>(counts.cv));
  transitions.reserve(channels * Screen::kLongestDelay);  // frames that leave at once
  for (int j = 0; j < counts.cv; ++j)
    cvs.emplace_back(counts.inputs(),
                     settings.gain_error_of_interest / calibration::visibility::kSeenDeviations);
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv, SignalKind::kPrediction})
    counters.bad_of[static_cast<std::size_t>(kind)].resize(
        static_cast<std::size_t>(counts.of(kind)));
}

void Monitor::State::begin_anew() {
  State fresh(model, counts, expected, settings, std::move(seldom));
  fresh.reader.begin_with(reader.give_screen());
  fresh.cvs = std::move(cvs);
  for (Cv& cv : fresh.cvs) {
    cv.judged = false;
    cv.settled = cv.followed_next = 0;
    cv.rival = {};
  }
  fresh.status = std::move(status);
  fresh.transitions = std::move(transitions);
  fresh.counters = std::move(counters);
  fresh.lost = std::move(lost);
  fresh.first = first;
  fresh.last_interval = last_interval;
  *this = std::move(fresh);
}

void Monitor::State::Cv::archive(Archive& a) {
  a(alarms, quality, evaluated, judged, compressed, settled, rival, followed_next);
}

void Monitor::State::archive(Archive& a) {
  // not archived: model, counts, expected, settings, held (construction)
  // not archived: rows, outside_values, scan (each sample and each search begins anew)
  a(reader, correlation, detector, nonlinear, outside, judge, cvs, status, judged_frames, counters,
    lost, first, last_interval);
  if (seldom) a(*seldom);
  a.within(judged_count, 0, judged_frames.size());
  a.varying(transitions);
  const int outside_signals = counts.cv + counts.aux;
  for (const Cv& cv : cvs)
    a.require(cv.rival.signal >= -1 && cv.rival.signal < outside_signals,
              "a signal that is not there");
  for (const ChannelStatus& channel : status)
    a.require(channel.confounder >= -1 && channel.confounder < counts.inputs() + outside_signals,
              "a signal that is not there");
  for (const AlarmTransition& one : transitions)
    a.require(one.cv >= 0 && one.cv < counts.cv && one.input >= 0 && one.input < counts.inputs(),
              "an alarm of a channel that is not there");
}

void Monitor::State::take_frame(const Frame& frame) {
  if (reader.missing() > 0) pass_gap(reader.missing());
  for (const int cv : reader.turned())
    if (reader.samples() > 1) begin_anew(cv);
  follow_compression();
  take_seldom(frame);
  count_bad(frame);
  take_sample(frame);
  take_outside(frame);
  evaluate();
  move_alarms();
  judge_channels();
  reader.tell(frame, judged_frames[judged_count++]);
}

void Monitor::State::count_bad(const Frame& frame) {
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv, SignalKind::kPrediction})
    for (int i = 0; i < counts.of(kind); ++i) {
      // What a reading's successors repeat is marked, and serves all the same.
      const bool usable =
          frame[kind].usable(i) || (kind == SignalKind::kCv && seldom && seldom->stands(i));
      if (kind != SignalKind::kPrediction || expected[static_cast<std::size_t>(i)])
        lost.take(frame, kind, i, usable);
      if (usable || (kind == SignalKind::kPrediction && !reader.predictions().given(i))) continue;
      ++counters.bad_values;
      ++counters.bad_of[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
    }
}

// What was learnt of held values and drawn lines says nothing once all is measured again.
void Monitor::State::follow_compression() {
  for (int j = 0; j < counts.cv; ++j) {
    const bool was =
        std::exchange(of(j).compressed, reader.screen().compressed(j) || held_input(j) >= 0);
    if (was && !of(j).compressed) begin_anew(j);
  }
}

void Monitor::State::begin_anew(int cv) {
  detector.start_afresh(cv, 0);
  nonlinear.silence(cv);
  of(cv).settled = 0;
  if (!at_readings(cv)) return;
  seldom->begin_anew(cv);
  stand_at_readings(cv);
}

void Monitor::State::stand_at_readings(int cv) {
  for (int i = 0; i < counts.inputs(); ++i)
    if (of(cv).alarms.state(i) == AlarmState::kActive) seldom->stand(cv, i);
}

// What stands of a CV between two readings is left to those who judge it by them, and its alarms
// with it.
void Monitor::State::take_seldom(const Frame& frame) {
  if (!seldom) return;
  seldom->take(frame, reader);
  for (const int cv : seldom->turned()) {
    if (at_readings(cv))
      stand_at_readings(cv);
    else
      begin_anew(cv);
  }
  for (int j = 0; j < counts.cv; ++j) {
    reader.read_seldom(j, seldom->stands(j));
    if (!seldom->judged(j) || of(j).compressed) continue;
    for (AlarmTransition one : at_readings(j)->transitions()) {
      one.cv = j;
      of(j).alarms.set(one.input, one.to);
      transitions.push_back(one);
    }
  }
}

void Monitor::State::pass_gap(std::int64_t missing) {
  counters.missing += static_cast<std::uint64_t>(missing);
  correlation.close_window();
  for (int j = 0; nonlinear.on() && j < counts.cv; ++j) {
    detector.fold(j);
    nonlinear.take(j, detector);
  }
  detector.skip(missing);
  nonlinear.skip(missing, detector);
  outside.skip(missing);
}

void Monitor::State::take_sample(const Frame& frame) {
  rows = reader.residuals().values();
  for (int j = 0; j < counts.cv; ++j)
    if (reader.predictions().unseen(j)) rows(j) = std::numeric_limits<double>::quiet_NaN();
  detector.update(reader.inputs().values(), rows);
  nonlinear.add_sample(detector);
  bool used = false;
  for (int j = 0; j < counts.cv; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const bool took_row = detector.took_row(j);
    const bool implausible = frame[SignalKind::kCv].quality[at] == Quality::kImplausible ||
                             (reader.predictions().given(j) &&
                              frame[SignalKind::kPrediction].quality[at] == Quality::kImplausible);
    const bool settling = reader.predictions().settling(j) || reader.predictions().unseen(j);
    of(j).settled += settling ? 0 : 1;
    of(j).quality.take({settling || std::isfinite(reader.residuals().values()(j)), implausible,
                        took_row, reader.screen().spikes(j)},
                       reader.samples());
    used = used || took_row || (seldom && seldom->judged(j));
  }
  if (used) ++counters.used;
  correlation.take(reader.inputs(), reader.residuals());
}

void Monitor::State::take_outside(const Frame& frame) {
  int at = 0;
  for (const SignalKind kind : {SignalKind::kSetpoint, SignalKind::kAux})
    for (int i = 0; i < frame[kind].size(); ++i)
      outside_values(at++) =
          frame[kind].usable(i) ? frame[kind].values(i) : std::numeric_limits<double>::quiet_NaN();
  outside.push(outside_values);
}

// Of each CV every so many samples, one CV after the other.
void Monitor::State::evaluate() {
  const std::int64_t stride = settings.evaluation_stride;
  for (int j = 0; j < counts.cv; ++j) {
    Cv& cv = of(j);
    const bool due = (reader.samples() + j * stride / counts.cv) % stride == 0;
    if (due) {
      detector.fold(j);
      judge_nonlinear(j);
    }
    if (at_readings(j)) continue;
    if (cv.alarms.isolating() || !detector.memory(j).ready()) cv.judged = false;
    cv.evaluated = (due || !cv.judged) && detector.memory(j).ready();
    if (!cv.evaluated) continue;
    cv.judged = true;
    for (int m = 0; m < detector.memory_count(); ++m)
      if (detector.memory(j, m).ready()) detector.evaluate(j, m);
    follow(j);
  }
}

// What no verdict can be drawn of says nothing of nonlinearity either, nor do coarse readings,
// whose steps are no line.
void Monitor::State::judge_nonlinear(int j) {
  bool serves = !of(j).rival.wins && belief(j).in_all();
  for (int i = 0; i < counts.inputs(); ++i) serves = serves && bad_data(j, i) == Reason::kNone;
  if (serves)
    nonlinear.evaluate(j, detector);
  else {
    nonlinear.take(j, detector);
    nonlinear.silence(j);
  }
}

// Where something is off: whether it follows a signal that is no input of the model, or one that
// nobody logs.
void Monitor::State::follow(int j) {
  Cv& cv = of(j);
  bool off = false;
  for (int m = 0; m < detector.memory_count(); ++m)
    for (int i = 0; i < counts.inputs() && detector.memory(j, m).ready(); ++i)
      off = off || judge.unlikely(detector.evidence(j, i, m));
  if (!off) cv.rival = {};
  if (!off || !detector.memory(j).ready() || reader.samples() < cv.followed_next) return;
  cv.followed_next = reader.samples() + calibration::confounding::kBetween;
  cv.rival = detector.rival(
      j, outside.followed(j, detector.history(), detector.regression(j), detector.usual_errors(j)));
  if (cv.rival.loses && is_unlike_errors(j)) cv.rival = {-1, true, false};
}

// Of a CV of which no channel that is off would show an error of interest: more inputs than CVs
// that move together can make up between them what nobody logs but an operator answers.
bool Monitor::State::is_unlike_errors(int j) const {
  if (!detector.memory(j).ready()) return false;
  bool off = false;
  for (int i = 0; i < counts.inputs(); ++i) {
    const ChannelEvidence& evidence = detector.evidence(j, i);
    if (!judge.unlikely(evidence)) continue;
    if (judge.shows_errors(evidence)) return false;
    off = true;
  }
  return off && detector.unlike_errors(j);
}

void Monitor::State::move_alarms() {
  for (int j = 0; j < counts.cv; ++j) {
    if (at_readings(j) && !of(j).compressed) continue;
    Cv& cv = of(j);
    const auto changed = [&](int input) {
      transitions.push_back({j, input, cv.alarms.state(input), status[index(j, input)]});
    };
    if (cv.rival.wins || cv.compressed)  // what spoke against a channel was never evidence
      cv.alarms.clear(changed);
    else if (cv.quality.implausible() || !cv.rival.loses)
      cv.alarms.hold();
    else
      cv.alarms.update(j, cv.evaluated, detector, scan, settings.alarm, belief(j), changed);
  }
}

void Monitor::State::judge_channels() {
  const bool against_line = settings.threshold == ThresholdKind::kMeanLine;
  if (against_line) correlation.evaluate();
  const double line = against_line ? correlation.mean_line() : 0.0;
  const bool mvs_still = reader.inputs().mvs_still();
  for (int i = 0; i < counts.inputs(); ++i) {
    for (int j = 0; j < counts.cv; ++j) {
      if (at_readings(j) && !of(j).compressed) {
        seldom->read(j, i, status[index(j, i)]);
        continue;
      }
      const RegressionMemory& memory = detector.memory(j);
      const bool overdue = static_cast<double>(of(j).settled) >=
                           calibration::bad_data::kWarmUps * memory.needed_rows();
      judge.judge({.input = i,
                   .bad_data = bad_data(j, i),
                   .spoilt = spoilt_input(j, i),
                   .overdue = overdue,
                   .memory = memory,
                   .evidence = detector.evidence(j, i),
                   .alarms = of(j).alarms,
                   .mvs_still = mvs_still,
                   .at_limit = reader.inputs().at_limit(i),
                   .confounded = !of(j).rival.loses,
                   .confounder = of(j).rival.signal < 0 ? -1 : counts.inputs() + of(j).rival.signal,
                   .peak = against_line ? correlation.peak(j, i) : CorrelationPeak{},
                   .mean_line = line,
                   .gain_variation = gain_variation(j, i),
                   .bends = bends(j, i),
                   .belief = belief(j)},
                  status[index(j, i)]);
    }
  }
}

Belief Monitor::State::belief(int cv) const {
  return belief_in(reader.screen().repeated_share(cv), settings.gain_error_of_interest);
}

double Monitor::State::gain_variation(int cv, int input) const {
  const Curvature* found = detector.curvature(cv);
  if (!found) return std::numeric_limits<double>::quiet_NaN();
  const Curvature::Channel& channel = found->channels[static_cast<std::size_t>(input)];
  return channel.sure_variation > 0.0 ? channel.gain_variation
                                      : std::numeric_limits<double>::quiet_NaN();
}

bool Monitor::State::bends(int cv, int input) const {
  const Curvature* found = detector.curvature(cv);
  if (!found) return false;
  const Curvature::Channel& channel = found->channels[static_cast<std::size_t>(input)];
  return channel.p_value < calibration::curvature::kChannelPValue &&
         channel.sure_variation >
             settings.materiality[index(cv, input) % settings.materiality.size()].gain;
}

// Why no verdict can be drawn, if none can. Lost: for as long as an input's pulse lags.
Reason Monitor::State::bad_data(int cv, int input) const {
  const Cv& judged = cvs[static_cast<std::size_t>(cv)];
  if (judged.compressed) return Reason::kCompressed;
  const CvQuality& quality = judged.quality;
  const bool cv_lost = quality.without_row() > settings.fir_lags &&
                       reader.residuals().unknown_run(cv) > settings.fir_lags &&
                       !reader.predictions().settling(cv);
  const bool input_lost = reader.inputs().unknown_run(input) > settings.fir_lags;
  return cv_lost || input_lost || missing_input(cv, input) >= 0 || quality.mostly_unknown() ||
                 quality.implausible()
             ? Reason::kBadData
             : Reason::kNone;
}

// The input that is to blame for bad data; -1: the CV itself, or this one.
int Monitor::State::spoilt_input(int cv, int input) const {
  if (!cvs[static_cast<std::size_t>(cv)].compressed) return missing_input(cv, input);
  return reader.screen().compressed(cv) ? -1 : held_input(cv);
}

// Another input that is lost, where the CV has no rows for so long: simulated or not, no row goes
// without it. Else -1.
int Monitor::State::missing_input(int cv, int input) const {
  if (cvs[static_cast<std::size_t>(cv)].quality.without_row() <= settings.fir_lags) return -1;
  for (int i = 0; i < counts.inputs(); ++i)
    if (i != input && reader.inputs().unknown_run(i) > settings.fir_lags) return i;
  return -1;
}

// An input from which the CV is simulated and which a historian has held: the plant moved, and
// nobody wrote it down. Once said, it takes half as much to be said again.
int Monitor::State::held_input(int cv) const {
  if (reader.screen().predicted(cv)) return -1;
  const NoiseLevel& noise = noise_of(cv);
  const double share = calibration::held_inputs::kShareOfNoise *
                       (cvs[static_cast<std::size_t>(cv)].compressed ? 0.5 : 1.0);
  return held.heaviest(cv, reader.screen(), noise.known() ? noise.scale() : 0.0, share);
}

Monitor::Monitor(const ModelSpec& spec, const SignalCounts& counts,
                 const std::vector<bool>& may_predict, const MonitorSettings& settings,
                 const AlarmSettings& alarms, Cycles cycles) {
  const LinearModel model(spec);
  const DerivedSettings derived = derive_settings(spec, model, settings, alarms);
  std::optional<SeldomCvs> seldom;
  if (cycles == Cycles::kAny) seldom.emplace(spec, counts, derived.fir_lags, settings, alarms);
  state_ = std::make_unique<State>(model, counts, may_predict, derived, std::move(seldom));
}
Monitor::Monitor(Monitor&&) noexcept = default;
Monitor& Monitor::operator=(Monitor&&) noexcept = default;
Monitor::~Monitor() = default;

void Monitor::archive(Archive& a) { state_->archive(a); }

void Monitor::push(const Frame& frame) {
  State& s = *state_;
  s.transitions.clear();
  s.judged_count = 0;
  ++s.counters.frames;
  if (!s.first && frame.interval <= s.last_interval) {
    ++s.counters.out_of_order;
    return;
  }
  s.first = false;
  s.last_interval = frame.interval;
  s.reader.push(frame);
  if (s.seldom) s.seldom->see(frame);
  if (s.reader.anew()) s.begin_anew();  // the screen keeps its frames
  while (const Frame* screened = s.reader.next()) s.take_frame(*screened);
  s.counters.implausible = s.reader.screen().counters();
}

void Monitor::correlate() {
  State& s = *state_;
  s.correlation.evaluate();
  for (int i = 0; i < s.counts.inputs(); ++i) {
    for (int j = 0; j < s.counts.cv; ++j) {
      const CorrelationPeak peak = s.correlation.peak(j, i);
      ChannelStatus& channel = s.status[s.index(j, i)];
      channel.partial_correlation = peak.value;
      channel.lag = peak.lag;
    }
  }
}

const ChannelStatus& Monitor::channel(int cv, int input) const {
  return state_->status[state_->index(cv, input)];
}
const ChannelNonlinearity& Monitor::nonlinearity(int cv, int input) const {
  const Monitor* seldom = state_->at_readings(cv);
  return seldom ? seldom->nonlinearity(0, input) : state_->nonlinear.result(cv, input);
}
void Monitor::stand(int cv, int input) {
  state_->of(cv).alarms.stand(input);
  if (state_->at_readings(cv)) state_->seldom->stand(cv, input);
}
AlarmState Monitor::alarm(int cv, int input) const { return state_->of(cv).alarms.state(input); }
Eigen::Ref<const Eigen::VectorXd> Monitor::partial_correlations(int cv, int input) const {
  return state_->correlation.values(cv, input);
}
bool Monitor::replaced(int cv) const {
  return state_->reader.screen().ceased(cv) && !state_->reader.predictions().given(cv);
}
bool Monitor::corrected(int cv) const { return state_->reader.predictions().corrected(cv); }

bool Monitor::of_other_model(int cv) const {
  return state_->reader.predictions().of_other_model(cv);
}
const NoiseLevel& Monitor::State::noise_of(int cv) const {
  const Monitor* seldom_read = at_readings(cv);
  return seldom_read ? seldom_read->state_->noise_of(0) : detector.regression(cv).noise();
}

double Monitor::read_every(int cv) const {
  return state_->at_readings(cv) ? state_->seldom->cycle(cv) : 0.0;
}
int Monitor::first_lag() const { return state_->settings.first_lag; }
int Monitor::last_lag() const { return state_->settings.last_lag; }
std::span<const JudgedFrame> Monitor::judged() const {
  return std::span<const JudgedFrame>(state_->judged_frames).first(state_->judged_count);
}
const std::vector<AlarmTransition>& Monitor::transitions() const { return state_->transitions; }
const MonitorCounters& Monitor::counters() const { return state_->counters; }
std::vector<LostSignal> Monitor::lost() const { return state_->lost.list(); }
double Monitor::samples_needed(int cv) const {
  if (state_->at_readings(cv)) return state_->seldom->samples_needed(cv);
  const RegressionMemory& memory = state_->detector.memory(cv);
  return std::max(0.0, memory.needed_rows() - static_cast<double>(memory.rows));
}

}  // namespace mpm
