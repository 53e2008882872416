#include "core/signal/screen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/archive/archive.hpp"

namespace mpm {

using calibration::extent::kMovesOfItself;
using calibration::repeats::kEndHits;
using calibration::repeats::kReturns;
using calibration::spikes::kFirstSamples;
using calibration::spikes::kJump;

namespace {

// The first four, or all of them.
constexpr std::array kScreened = {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                  SignalKind::kPrediction, SignalKind::kSetpoint};

bool is_input(SignalKind kind) { return kind == SignalKind::kMv || kind == SignalKind::kDv; }

}  // namespace

void Screen::Repeats::take(double value) {
  if (taken == 0) {
    low = high = last = before_last = value;
    at_low = at_high = 1;
    taken = 1;
    return;
  }
  const bool same = value == last;
  // Of a long run only its beginning tells of the resolution.
  if (may_be_held || !coarse() || !frozen()) {
    counted += 1.0;
    repeated += same ? 1.0 : 0.0;
  }
  const auto hit = [&](double& end, int& hits, bool beyond) {
    if (beyond) {
      end = value;
      hits = 1;
    } else if (value == end) {
      hits = std::min(hits + 1, kEndHits);
    }
  };
  hit(low, at_low, value < low);
  hit(high, at_high, value > high);
  const bool at_an_end = value == low || value == high;  // where a clipped signal returns to
  if (!same && taken > 1 && value == before_last && !at_an_end)
    returns = std::min(returns + 1, kReturns);
  run = same ? run + 1 : 0;
  if (!same) before_last = last;
  last = value;
  taken = std::min(taken + 1, 2);
}

void Screen::Repeats::forget_ends() { taken = run = 0; }

void Screen::Repeats::archive(Archive& a) {
  // not archived: may_be_held (construction)
  a(last, before_last, run, returns, repeated, counted, low, high, at_low, at_high, taken);
}

bool Screen::Repeats::frozen() const {
  if (!coarse() && !may_be_held) return run >= calibration::repeats::kFrozenOfFine;
  if (may_be_held && run > calibration::repeats::kLongestOfInput) return false;
  return run > 0 && run * std::log(repeated / counted) < std::log(calibration::repeats::kChance);
}

bool Screen::Repeats::at_end() const {
  if (coarse() || !(high > low)) return false;  // a coarse signal is there by right
  return (last == low && at_low >= kEndHits) || (last == high && at_high >= kEndHits);
}

Screen::Screen(const SignalCounts& counts, std::vector<bool> may_predict, std::vector<bool> acts,
               int dead_time, int turning, Looks looks)
    : counts_(counts),
      may_predict_(std::move(may_predict)),
      predicted_(static_cast<std::size_t>(counts.cv)),
      acts_(std::move(acts)),
      dead_time_(dead_time),
      turning_(turning),
      looks_(looks),
      since_rest_(static_cast<std::size_t>(counts.inputs()), 0),
      ring_(kHeld, Frame(counts)),
      marked_(kHeld),
      jumps_(static_cast<std::size_t>(counts.cv)),
      compression_(static_cast<std::size_t>(counts.cv)),
      input_compression_(static_cast<std::size_t>(counts.inputs())),
      read_seldom_(static_cast<std::size_t>(counts.cv), false) {
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind) {
    const auto count = static_cast<std::size_t>(counts.of(static_cast<SignalKind>(kind)));
    repeats_.emplace_back(count);
    ranges_.emplace_back(count);
    if (!is_input(static_cast<SignalKind>(kind))) continue;
    for (Repeats& repeats : repeats_.back()) {
      repeats.may_be_held = true;
      repeats.repeated = calibration::repeats::kPriorRepeatedOfInput;
    }
  }
}

void Screen::Predicted::archive(Archive& a) { a(comes, came, against); }

void Screen::Jumps::archive(Archive& a) { a(scale, samples, home, moved, since_home, spikes); }

void Screen::Range::archive(Archive& a) {
  a(extent, far, former, left, last, taken, rejected, pulses, low, high, close, moved, came_from);
  a.within(out, 0, kLongestDelay);
  a.within(values, 0, calibration::extent::kFirstPhase);
}

void Screen::archive(Archive& a) {
  // not archived: counts_, may_predict_, acts_, dead_time_, turning_, looks_ (construction)
  // not archived: all_mvs_rest_, longest_out_, run_ended_, anew_, one_is_far_ (each frame says it
  // anew)
  a(predicted_, inputs_matter_, since_rest_, ring_, marked_);
  a.within(position_, 0, kHeld - 1);
  a.within(held_, 0, kHeld);
  a.within(pushed_, 0, kDelay + 1);
  a(repeats_, ranges_, jumps_, compression_, input_compression_, read_seldom_, counters_);
}

void Screen::push(const Frame& frame) {
  position_ = (position_ + 1) % kHeld;
  ring_[static_cast<std::size_t>(position_)] = frame;
  marked_[static_cast<std::size_t>(position_)] = {};
  held_ = std::min(held_ + 1, kHeld);
  pushed_ = std::min(pushed_ + 1, kDelay + 1);
  longest_out_ = 0;
  run_ended_ = anew_ = false;
  one_is_far_ = far_signals() == 1;

  for (const SignalKind kind : screened()) {
    screen_far(kind);
    const SignalBlock& block = ago(0)[kind];
    for (int i = 0; i < block.size(); ++i)
      if (block.usable(i))
        repeats_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)].take(block.values(i));
  }
  const SignalBlock& measured = ago(0)[SignalKind::kCv];
  for (int j = 0; j < counts_.cv; ++j)
    if (measured.usable(j)) compression_[static_cast<std::size_t>(j)].take(measured.values(j));
  if (inputs_matter_) follow_compression_of_inputs();
  follow_predictions(frame[SignalKind::kPrediction]);
  follow_inputs();
  if (looks_ == Looks::kAll) screen_repeats();
  if (looks_ == Looks::kAll && pushed_ > kDelay) {
    screen_pulses(SignalKind::kMv);
    screen_pulses(SignalKind::kDv);
    for (int j = 0; j < counts_.cv; ++j) screen_spikes(j);
  }
  for (const SignalKind kind : screened()) learn_range(kind);
}

const Frame* Screen::next() {
  const int age = held_ - 1;
  const int delay = looks_ == Looks::kAll ? kDelay : 0;
  if (age < (run_ended_ ? 0 : std::max(delay, longest_out_))) return nullptr;
  --held_;
  const ScreenCounters& marked = marked_[place(age)];
  counters_.frozen += marked.frozen;
  counters_.clipped += marked.clipped;
  counters_.spikes += marked.spikes;
  return &ago(age);
}

void Screen::end_run() {
  run_ended_ = true;
  for (const SignalKind kind : screened()) {
    auto& ranges = ranges_[static_cast<std::size_t>(kind)];
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      Range& range = ranges[i];
      if (std::exchange(range.out, 0) > 0) reject_excursion(kind, static_cast<int>(i), range);
    }
  }
}

std::span<const SignalKind> Screen::screened() const {
  return std::span(kScreened).first(kScreened.size() - (looks_ == Looks::kFar ? 0 : 1));
}

void Screen::follow_compression_of_inputs() {
  for (int i = 0; i < counts_.inputs(); ++i) {
    const SignalBlock& block = ago(0)[i < counts_.mv ? SignalKind::kMv : SignalKind::kDv];
    const int at = i < counts_.mv ? i : i - counts_.mv;
    if (block.usable(at)) input_compression_[static_cast<std::size_t>(i)].take(block.values(at));
  }
}

double Screen::repeated_share(int cv) const {
  const Repeats& repeats =
      repeats_[static_cast<std::size_t>(SignalKind::kCv)][static_cast<std::size_t>(cv)];
  return repeats.coarse() ? repeats.repeated / repeats.counted : 0.0;
}

bool Screen::learns(int cv) const {
  const auto learns_range = [this](SignalKind kind, int index) {
    const auto& ranges = ranges_[static_cast<std::size_t>(kind)];
    return !ranges[static_cast<std::size_t>(index)].extent.known();
  };
  if (learns_range(SignalKind::kCv, cv)) return true;
  if (predicted(cv)) return learns_range(SignalKind::kPrediction, cv);
  for (int i = 0; i < counts_.inputs(); ++i) {
    if (!acts_[static_cast<std::size_t>(i * counts_.cv + cv)]) continue;
    if (i < counts_.mv ? learns_range(SignalKind::kMv, i)
                       : learns_range(SignalKind::kDv, i - counts_.mv))
      return true;
  }
  return false;
}

void Screen::follow_predictions(const SignalBlock& predictions) {
  for (int j = 0; j < counts_.cv; ++j) {
    const auto s = static_cast<std::size_t>(j);
    Predicted& predicted = predicted_[s];
    const bool comes = may_predict_[s] && predictions.usable(j);
    predicted.against = comes == predicted.comes ? 0 : predicted.against + 1;
    if (predicted.against < (predicted.came ? turning_ : 1)) continue;
    predicted = {comes, true, 0};
    jumps_[s] = Jumps{};  // from now on of the residual, or of the measurement
  }
  inputs_matter_ = std::any_of(predicted_.begin(), predicted_.end(),
                               [](const Predicted& predicted) { return !predicted.comes; });
}

void Screen::follow_inputs() {
  all_mvs_rest_ = true;
  for (int i = 0; i < counts_.inputs(); ++i) {
    const bool is_mv = i < counts_.mv;
    const auto& of_kind =
        repeats_[static_cast<std::size_t>(is_mv ? SignalKind::kMv : SignalKind::kDv)];
    const bool rests = of_kind[static_cast<std::size_t>(is_mv ? i : i - counts_.mv)].run > 0;
    int& since = since_rest_[static_cast<std::size_t>(i)];
    since = rests ? 0 : since + 1;
    if (is_mv && !rests) all_mvs_rest_ = false;
  }
}

bool Screen::may_rest(SignalKind kind, int index) const {
  if (kind == SignalKind::kMv) return all_mvs_rest_;
  if (kind != SignalKind::kPrediction) return false;
  for (int i = 0; i < counts_.inputs(); ++i)
    if (acts_[static_cast<std::size_t>(i * counts_.cv + index)] &&
        since_rest_[static_cast<std::size_t>(i)] > dead_time_ + 1)
      return false;
  return true;
}

void Screen::screen_repeats() {
  if (inputs_matter_) {
    screen_repeats(SignalKind::kMv);
    screen_repeats(SignalKind::kDv);
  }
  screen_repeats(SignalKind::kPrediction);
  screen_repeats(SignalKind::kCv);
}

void Screen::screen_repeats(SignalKind kind) {
  const bool input = is_input(kind);
  for (int i = 0; i < ago(0)[kind].size(); ++i) {
    const Repeats& repeats = repeats_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
    if (!ago(0)[kind].usable(i)) continue;
    if (kind == SignalKind::kPrediction && !predicted(i)) continue;
    if (may_rest(kind, i) || (input && repeats.at_end())) continue;
    if (repeats.at_end()) mark(kind, i, 0, &ScreenCounters::clipped);
    if (!repeats.frozen()) continue;
    for (int frames = 0; frames < std::min({repeats.run, kDelay + 1, pushed_}); ++frames)
      mark(kind, i, frames, &ScreenCounters::frozen);
  }
}

void Screen::mark(SignalKind kind, int index, int frames, std::uint64_t ScreenCounters::*counter) {
  Quality& quality = ago(frames)[kind].quality[static_cast<std::size_t>(index)];
  if (quality > Quality::kUncertain) return;
  quality = Quality::kImplausible;
  if (kind == SignalKind::kCv && read_seldom_[static_cast<std::size_t>(index)]) return;
  ++(marked_[place(frames)].*counter);
}

// What should move smoothly: the residual where a prediction comes along, else the measurement.
bool Screen::level(int cv, int frames, double& value) {
  const Frame& frame = ago(frames);
  if (!frame[SignalKind::kCv].usable(cv)) return false;
  value = frame[SignalKind::kCv].values(cv);
  if (!predicted(cv)) return true;
  if (!frame[SignalKind::kPrediction].usable(cv)) return false;
  value -= frame[SignalKind::kPrediction].values(cv);
  return true;
}

void Screen::screen_spikes(int cv) {
  // Oldest first: levels[0] is about to leave, levels[1] to be judged against what follows it.
  std::array<double, kDelay + 1> levels{};
  std::array<bool, kDelay + 1> known{};
  for (int f = 0; f <= kDelay; ++f)
    known[static_cast<std::size_t>(f)] = level(cv, kDelay - f, levels[static_cast<std::size_t>(f)]);
  Jumps& jumps = jumps_[static_cast<std::size_t>(cv)];
  ++jumps.since_home;
  if (known[0]) {
    jumps.moved = std::abs(levels[0] - jumps.home);
    jumps.home = levels[0];
    jumps.since_home = 0;
  }
  if (jumps.samples > kFirstSamples && jumps.since_home <= kDelay && known[1]) {
    const double away = levels[1] - jumps.home;
    const auto back_at = [&](std::size_t next) {
      // A measurement is back at one step: a process, too, may turn within two.
      const std::size_t from = predicted(cv) ? 1 : next - 1;
      if (!known[next] || !known[from]) return false;
      const double home = levels[next] - levels[from];
      return std::abs(home) > kJump * jumps.scale && away * home < 0.0 &&
             std::abs(levels[next] - jumps.home) < calibration::spikes::kBackShare * std::abs(away);
    };
    // What was on its way turns, as a process does; an instrument's spike begins from rest.
    const bool sudden = std::abs(away) > calibration::spikes::kSudden * jumps.moved;
    if (std::abs(away) > kJump * jumps.scale && sudden && (back_at(2) || back_at(3))) {
      mark(SignalKind::kCv, cv, kDelay - 1, &ScreenCounters::spikes);
      ++jumps.spikes;
    }
  }
  if (!known[2] || !known[3]) return;
  // A coarse reading that repeats says nothing of how far the next one jumps: at least a step.
  const SignalBlock& measured = ago(0)[SignalKind::kCv];
  if (measured.values(cv) == ago(1)[SignalKind::kCv].values(cv)) return;
  const double difference = std::abs(levels[3] - levels[2]);
  jumps.samples += 1.0;
  const double bounded = jumps.samples > kFirstSamples
                             ? std::min(difference, calibration::spikes::kBound * jumps.scale)
                             : difference;
  jumps.scale +=
      (bounded - jumps.scale) / std::min(jumps.samples, calibration::spikes::kScaleSamples);
}

// Of two samples at most: what ago(kDelay) and ago(0) enclose.
void Screen::screen_pulses(SignalKind kind) {
  for (int i = 0; i < ago(0)[kind].size(); ++i) {
    Range& range = ranges_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
    range.pulses -= range.pulses / calibration::pulses::kSamples;
    if (!(range.extent.width() > 0.0)) continue;
    const auto away = [&](int frames) {
      const SignalBlock& block = ago(frames)[kind];
      return block.usable(i) ? range.extent.beyond(block.values(i)) : -1.0;
    };
    int length = 0;
    while (length < kDelay - 1 && away(length + 1) > calibration::pulses::kAway) ++length;
    if (length == 0 || away(0) != 0.0 || away(length + 1) != 0.0) continue;
    range.pulses += 1.0;
    if (range.pulses > calibration::pulses::kMost) continue;
    for (int frames = 1; frames <= length; ++frames) mark(kind, i, frames, &ScreenCounters::spikes);
  }
}

int Screen::far_signals() const {
  int count = 0;
  for (const SignalKind kind : screened()) {
    const SignalBlock& block = ring_[place(0)][kind];
    const auto& ranges = ranges_[static_cast<std::size_t>(kind)];
    for (int i = 0; i < block.size(); ++i) {
      const Extent& extent = ranges[static_cast<std::size_t>(i)].extent;
      count += block.usable(i) && extent.known() && extent.width() > 0.0 &&
                       extent.beyond(block.values(i)) > calibration::extent::kTooFarAlone
                   ? 1
                   : 0;
    }
  }
  return count;
}

// Before anything is learnt from it.
void Screen::screen_far(SignalKind kind) {
  for (int i = 0; i < ago(0)[kind].size(); ++i) {
    Range& range = ranges_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
    const bool usable = ago(0)[kind].usable(i);
    const bool marked = usable && absurd(kind, i, range);
    if (range.out > 0)
      ++range.out;
    else if (!usable || marked)
      continue;
    if (usable && !marked && began_wild(range, ago(0)[kind].values(i))) {
      range = Range{};
      repeats_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)].forget_ends();
      forget_jumps(kind, i);
      anew_ = true;
    }
    if (usable && !marked) follow_excursion(kind, i, range);
    if (usable) range.last = ago(0)[kind].values(i);
    if (range.out > kLongestDelay) end_excursion(kind, i, range);
    longest_out_ = std::max(longest_out_, range.out);
  }
}

/// Whether the signal has jumped to where it has been for long now, and what it was before, from
/// its first values on, is too far away for any process. One that rests there may have been
/// switched.
bool Screen::began_wild(Range& range, double value) {
  if (range.values == calibration::extent::kFirstPhase) return false;
  const double narrow = range.extent.width() / calibration::extent::kTooFar;
  const double low = std::min(range.low, value), high = std::max(range.high, value);
  if (++range.values == 1 || high - low > narrow) {
    range.low = range.high = value;
    range.came_from = range.last;
    range.close = 1;
    range.moved = 0;
    return false;
  }
  range.low = low;
  range.high = high;
  ++range.close;
  range.moved += value != range.last ? 1 : 0;
  return range.close > calibration::extent::kPatience && range.moved >= kMovesOfItself &&
         std::abs(range.low - range.came_from) > calibration::extent::kIsolated * narrow;
}

/// Marks a value that is too far away for any process, until it has been there for long.
bool Screen::absurd(SignalKind kind, int index, Range& range) {
  const double value = ago(0)[kind].values(index);
  if (range.left && range.former.beyond(value) <= 0.0) {
    const Extent home = range.former;
    range = Range{};
    range.extent = home;
    mark_isolated(kind, index, range, 1);
    anew_ = true;  // it was not there in truth
    return false;
  }
  // Among values too far away one that only happens to be nearer is none of the process either.
  const double limit = range.far > 0 ? calibration::extent::kHome
                       : one_is_far_ ? calibration::extent::kTooFarAlone
                                     : calibration::extent::kTooFar;
  const bool far =
      range.extent.known() && range.extent.width() > 0.0 && range.extent.beyond(value) > limit;
  range.far = far ? range.far + 1 : 0;
  if (!far) return false;
  if (range.far <= calibration::extent::kPatience) {
    mark(kind, index, 0, &ScreenCounters::spikes);
    return true;
  }
  const Extent former = range.extent;
  range = Range{};
  range.former = former;
  range.left = true;
  anew_ = true;
  return false;
}

/// Whether the signal goes far beyond all that it has been, and comes back as abruptly.
void Screen::follow_excursion(SignalKind kind, int index, Range& range) {
  if (!range.extent.known()) return;
  const double value = ago(0)[kind].values(index);
  const double away = range.extent.beyond(value);
  if (range.out > 0 && !range.extent.back(value, range.last)) return;
  const bool abrupt = range.extent.beyond(range.last) > calibration::extent::kIsolated;
  const double enough = std::min(std::ldexp(calibration::extent::kIsolated, range.rejected),
                                 calibration::extent::kTooFar);
  const bool begins = range.extent.width() > 0.0
                          ? away > enough
                          : away > 0.0 && range.rejected < calibration::extent::kOftenFromRest;
  if (range.out > 0 && abrupt) {
    reject_excursion(kind, index, range);
    range.rejected += begins ? 0 : 1;  // from one wild value to the next
  } else if (range.out > 0) {
    end_excursion(kind, index, range);
  }
  if (begins) range.out = std::max(range.out, 1);
}

// Of the frames that nobody has yet.
void Screen::mark_isolated(SignalKind kind, int index, const Range& range, int first) {
  for (int frames = first; frames < held_; ++frames)
    if (ago(frames)[kind].usable(index) &&
        range.extent.beyond(ago(frames)[kind].values(index)) > calibration::extent::kIsolated)
      mark(kind, index, frames, &ScreenCounters::spikes);
}

void Screen::reject_excursion(SignalKind kind, int index, Range& range) {
  mark_isolated(kind, index, range, range.out > 0 ? 1 : 0);
  range.out = 0;
  repeats_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(index)].forget_ends();
  if (!std::exchange(range.taken, false)) return;
  anew_ = true;
  forget_jumps(kind, index);
}

/// What was learnt of how far it moves from one value to the next was not of the process.
void Screen::forget_jumps(SignalKind kind, int index) {
  if (kind != SignalKind::kCv && kind != SignalKind::kPrediction) return;
  Jumps& jumps = jumps_[static_cast<std::size_t>(index)];
  jumps = {.spikes = jumps.spikes};
}

/// Its first value has stayed, or comes back by and by: that is where the signal goes. What is far
/// from there too is on another excursion.
void Screen::end_excursion(SignalKind kind, int index, Range& range) {
  bool stayed = false;
  int frames = std::exchange(range.out, 0) - 1;
  range.taken = false;
  for (; frames >= 0; --frames) {
    if (!ago(frames)[kind].usable(index)) continue;
    const double value = ago(frames)[kind].values(index);
    if (stayed && range.extent.beyond(value) > calibration::extent::kIsolated) {
      range.out = frames + 1;
      return;
    }
    if (frames > 0) range.extent.learn(value);
    stayed = true;
  }
}

// The first values as they come, later ones once two others have followed them and no excursion
// is open.
void Screen::learn_range(SignalKind kind) {
  for (int i = 0; i < ago(0)[kind].size(); ++i) {
    Range& range = ranges_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
    if (!range.extent.known()) {
      if (ago(0)[kind].usable(i)) learn_first(kind, i, range);
    } else if (range.out < kDelay && pushed_ >= kDelay && ago(kDelay - 1)[kind].usable(i)) {
      range.extent.learn(ago(kDelay - 1)[kind].values(i));
    }
  }
}

void Screen::learn_first(SignalKind kind, int index, Range& range) {
  const Extent::Verdict verdict = range.extent.learn(ago(0)[kind].values(index));
  range.taken = verdict.wild || verdict.out > held_;
  if (verdict.wild) {
    reject_excursion(kind, index, range);
    ++range.rejected;
  }
  if (verdict.out == 0) return;
  range.out = verdict.out;
  longest_out_ = std::max(longest_out_, std::min(range.out, held_));
}

}  // namespace mpm
