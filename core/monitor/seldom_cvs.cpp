#include "core/monitor/seldom_cvs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/model/model_part.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {
namespace {

namespace seldom = calibration::seldom_read;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Of the unit, in the part of one CV.
SignalCounts counts_of_one(SignalCounts counts) {
  counts.cv = 1;
  counts.raw = 0;
  return counts;
}

void put(SignalBlock& block, int index, double value) {
  const bool known = std::isfinite(value);
  block.values(index) = known ? value : 0.0;
  block.quality[static_cast<std::size_t>(index)] = known ? Quality::kGood : Quality::kBad;
}

void copy(const SignalBlock& from, int index, SignalBlock& to, int at) {
  to.values(at) = from.values(index);
  to.quality[static_cast<std::size_t>(at)] = from.quality[static_cast<std::size_t>(index)];
}

}  // namespace

SeldomCvs::SeldomCvs(const ModelSpec& model, const SignalCounts& counts, int lags,
                     const MonitorSettings& settings, const AlarmSettings& alarms)
    : model_(model),
      counts_(counts),
      lags_(lags),
      settings_(settings),
      alarms_(alarms),
      seen_(Screen::kHeld, {0, Eigen::VectorXd::Constant(counts.cv, kUnknown)}),
      cycles_(static_cast<std::size_t>(counts.cv)),
      tried_(static_cast<std::size_t>(counts.cv), 0.0),
      parts_(static_cast<std::size_t>(counts.cv)) {
  turned_.reserve(static_cast<std::size_t>(counts.cv));
  // One CV of a unit: its channels share the rate of false alarms with those of the others.
  settings_.false_alarm_rate /= std::max(1, counts.cv);
}

SeldomCvs::Part::Part(Monitor of_cv, double samples, const SignalCounts& counts)
    : monitor(std::move(of_cv)),
      cycle(samples),
      pending(counts),
      sums(Eigen::VectorXd::Zero(counts.inputs())),
      summands(Eigen::VectorXd::Zero(counts.inputs())) {}

int SeldomCvs::lags_at(double cycle) const {
  return std::max(seldom::kFewestLags, static_cast<int>(std::ceil(lags_ / cycle)) + 1);
}

std::optional<SeldomCvs::Part> SeldomCvs::make(int cv, double cycle) const {
  std::optional<ModelSpec> model = at_longer_sample_time(model_, {cv}, cycle);
  if (!model) return std::nullopt;
  model->disturbances.clear();  // they are in the predictions
  MonitorSettings settings = settings_;
  settings.fir_lags = lags_at(cycle);
  settings.channel_materiality.clear();
  for (ChannelMateriality limits : settings_.channel_materiality)
    if (std::exchange(limits.cv, 0) == cv) settings.channel_materiality.push_back(limits);
  const SignalCounts counts = counts_of_one(counts_);
  return Part(Monitor(*model, counts, {true}, settings, alarms_, Monitor::Cycles::kNone), cycle,
              counts);
}

void SeldomCvs::see(const Frame& frame) {
  Seen& seen = seen_[next_];
  next_ = (next_ + 1) % seen_.size();
  seen.interval = frame.interval;
  const SignalBlock& measured = frame[SignalKind::kCv];
  for (int j = 0; j < counts_.cv; ++j)
    seen.values(j) = measured.usable(j) ? measured.values(j) : kUnknown;
}

void SeldomCvs::take(const Frame& frame, const UnitReader& reader) {
  turned_.clear();
  interval_ = frame.interval;
  const auto seen = std::find_if(seen_.begin(), seen_.end(),
                                 [&](const Seen& one) { return one.interval == frame.interval; });
  for (int j = 0; j < counts_.cv; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const auto reading =
        cycles_[at].take(frame.interval, seen == seen_.end() ? kUnknown : seen->values(j));
    follow_cycle(j);
    std::optional<Part>& part = parts_[at];
    if (!part) continue;
    part->judged = reading && part->is_pending;
    if (part->judged) part->push();
    if (reading) begin_reading(j, *reading, frame, reader);
    part->add(frame);
  }
}

void SeldomCvs::follow_cycle(int cv) {
  const auto at = static_cast<std::size_t>(cv);
  const double cycle = cycles_[at].samples();
  if (cycle == tried_[at]) return;
  tried_[at] = cycle;
  const bool was = parts_[at].has_value();
  parts_[at].reset();
  if (cycle > 0.0) parts_[at] = make(cv, cycle);
  if (was || parts_[at]) turned_.push_back(cv);
}

void SeldomCvs::begin_anew(int cv) {
  const auto at = static_cast<std::size_t>(cv);
  if (parts_[at]) parts_[at] = make(cv, parts_[at]->cycle);
}

void SeldomCvs::begin_reading(int cv, const ReadingCycle::Reading& reading, const Frame& frame,
                              const UnitReader& reader) {
  Part& one = part(cv);
  Frame& pending = one.pending;
  pending.interval += reading.cycles;
  pending.source_time_ns = frame.source_time_ns;
  put(pending[SignalKind::kCv], 0, reading.value);
  put(pending[SignalKind::kPrediction], 0,
      reader.predictions().unseen(cv) ? kUnknown : reader.predicted()(cv));
  copy(frame[SignalKind::kSetpoint], cv, pending[SignalKind::kSetpoint], 0);
  for (int i = 0; i < counts_.aux; ++i)
    copy(frame[SignalKind::kAux], i, pending[SignalKind::kAux], i);
  one.sums.setZero();
  one.summands.setZero();
  one.is_pending = true;
}

void SeldomCvs::Part::add(const Frame& frame) {
  const SignalBlock &mvs = frame[SignalKind::kMv], &dvs = frame[SignalKind::kDv];
  for (int i = 0; i < static_cast<int>(sums.size()); ++i) {
    const bool is_mv = i < mvs.size();
    const SignalBlock& block = is_mv ? mvs : dvs;
    const int at = is_mv ? i : i - mvs.size();
    if (!block.usable(at)) continue;
    sums(i) += block.values(at);
    summands(i) += 1.0;
  }
}

void SeldomCvs::Part::push() {
  SignalBlock &mvs = pending[SignalKind::kMv], &dvs = pending[SignalKind::kDv];
  for (int i = 0; i < static_cast<int>(sums.size()); ++i) {
    const bool is_mv = i < mvs.size();
    put(is_mv ? mvs : dvs, is_mv ? i : i - mvs.size(),
        summands(i) > 0.0 ? sums(i) / summands(i) : kUnknown);
  }
  monitor.push(pending);
  const std::vector<LostSignal> all = monitor.lost();
  lost = std::any_of(all.begin(), all.end(),
                     [](const LostSignal& one) { return one.kind == SignalKind::kCv; });
}

bool SeldomCvs::stands(int cv) const {
  const auto at = static_cast<std::size_t>(cv);
  return parts_[at] && !parts_[at]->lost &&
         cycles_[at].elapsed(interval_) <= seldom::kStandingCycles * parts_[at]->cycle;
}

void SeldomCvs::read(int cv, int input, ChannelStatus& status) const {
  const Part& one = part(cv);
  const double correlation = status.partial_correlation;
  const int lag = status.lag;
  status = one.monitor.channel(0, input);
  status.partial_correlation = correlation;
  status.lag = lag;
  status.dead_time *= one.cycle;
  status.dead_time_error.value *= one.cycle;
  status.dead_time_error.deviation *= one.cycle;
  // Of the part: inputs, one set-point, auxiliary signals.
  if (status.confounder == counts_.inputs())
    status.confounder += cv;
  else if (status.confounder > counts_.inputs())
    status.confounder += counts_.cv - 1;
  const double lost = cycles_[static_cast<std::size_t>(cv)].elapsed(interval_) / one.cycle;
  if (lost <= lags_at(one.cycle)) return;
  status.verdict = Verdict::kUndetermined;
  status.reason = Reason::kBadData;
  status.confounder = -1;
}

double SeldomCvs::samples_needed(int cv) const {
  const Part& one = part(cv);
  return std::ceil(one.monitor.samples_needed(0) * one.cycle);
}

void SeldomCvs::Seen::archive(Archive& a) { a(interval, values); }

void SeldomCvs::Part::archive(Archive& a) {
  // not archived: cycle (construction)
  a(monitor, pending, is_pending, judged, lost, sums, summands);
}

void SeldomCvs::archive(Archive& a) {
  // not archived: model_, counts_, lags_, settings_, alarms_ (construction)
  a(seen_, interval_, cycles_, tried_);
  a.within(next_, 0, seen_.size() - 1);
  for (std::size_t j = 0; j < parts_.size(); ++j) {
    bool there = parts_[j].has_value();
    double cycle = there ? parts_[j]->cycle : 0.0;
    a(there, cycle);
    a.require(!there || (cycle > 1.0 && cycle <= readings::kLongest), "no cycle of readings");
    if (a.reads()) {
      parts_[j].reset();
      if (there) parts_[j] = make(static_cast<int>(j), cycle);
      a.require(there == parts_[j].has_value(), "readings of a CV that cannot be judged so");
    }
    if (parts_[j]) parts_[j]->archive(a);
  }
  // not archived: turned_ (of each frame anew)
}

}  // namespace mpm
