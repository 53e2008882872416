#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/signal/calibration.hpp"
#include "core/signal/extent.hpp"
#include "core/signal/frame.hpp"
#include "core/statistics/compression.hpp"

namespace mpm {

class Archive;

/// What the screen found implausible, in values of the frames that have left it.
struct ScreenCounters {
  std::uint64_t frozen = 0;
  std::uint64_t clipped = 0;
  std::uint64_t spikes = 0;

  template <class Archive>
  void archive(Archive& a) {
    a(frozen, clipped, spikes);
  }
};

/// Looks at the values that claim to be good and marks those that no process gives: a signal
/// that repeats one value longer than its resolution explains (frozen), rests at the end of its
/// range (clipped), jumps away and right back (spike), or lies absurdly far outside all that it has
/// ever been (wild, counted with the spikes). To judge a value by what follows it,
/// frames pass with a delay of `kDelay`. Where a signal goes far beyond all that it has been, they
/// wait until it is back, which then was an excursion and none of the process, or has stayed: a
/// step is taken whole, only later, `kLongestDelay` at most. Where it has begun absurdly far away
/// and jumps to where it is from then on, what was learnt until then is worth nothing (`anew`).
///
/// An input that leaves all that it has been by as much again, for a sample or two, and is right
/// back, is marked too, unless it does so often: the plant may have seen it, but one such value
/// that only a gateway has made weighs more than thousands of others, and a real one is worth the
/// rows that it costs.
///
/// Inputs may rest: a controller in manual or at a limit holds them, and some move only now and
/// then. They count as frozen only where `inputs_matter` (predictions are simulated from them),
/// inside their range, while another MV moves, for longer than they usually rest, and not for long:
/// who stands still for good is held; predictions only where an input that acts on them has moved
/// all the time of its dead time. What a signal's resolution explains is learnt: a coarse signal
/// also returns to the value before the last, a fine one never does. A fine one may repeat a value
/// once, where few digits are written down, and is frozen if it does so twice in a row; of a coarse
/// one, with a share r of repetitions, a run is frozen once r^length falls below one in a million.
/// No allocation after construction.
class Screen {
 public:
  static constexpr int kDelay = 3;
  static constexpr int kLongestDelay = calibration::extent::kLongestBurst;
  static constexpr int kHeld = kLongestDelay + 2;  ///< frames; no more leave at once

  /// What is marked: all that is said above, or only what goes far beyond all that a signal has
  /// been and comes back, in set-points too; then frames wait for nothing else.
  enum class Looks { kAll, kFar };

  /// `may_predict[j]`: a prediction of CV j may come with the frames. `acts[input * cvs + cv]`: the
  /// model has that channel; `dead_time`: its longest, samples. `turning`: see `predicted`.
  Screen(const SignalCounts& counts, std::vector<bool> may_predict, std::vector<bool> acts,
         int dead_time, int turning, Looks looks = Looks::kAll);
  /// Where no prediction will come.
  Screen(const SignalCounts& counts, Looks looks)
      : Screen(counts, std::vector<bool>(static_cast<std::size_t>(counts.cv), false),
               std::vector<bool>(static_cast<std::size_t>(counts.cv * counts.inputs()), true), 0, 1,
               looks) {}

  void push(const Frame& frame);
  /// The next frame that leaves, with its qualities as found; null where there is none. Valid until
  /// the next call.
  [[nodiscard]] const Frame* next();
  /// The next frame is of another run, and those that wait are to leave (`next`): what is far in
  /// them is marked, for nobody will know whether it stays.
  void end_run();

  /// The CV is read only every so many samples: what stands until its next reading is marked, and
  /// not counted.
  void read_seldom(int cv, bool seldom) { read_seldom_[static_cast<std::size_t>(cv)] = seldom; }

  [[nodiscard]] const ScreenCounters& counters() const { return counters_; }
  /// Whether with the last frame it turned out that what was learnt of some signal was of wild
  /// values, or that it lives elsewhere from now on: statistics over both are worth nothing.
  [[nodiscard]] bool anew() const { return anew_; }
  /// Whether predictions of the CV come: from the first one on, until none has come in `turning`
  /// frames in a row, and again once they have come in as many.
  [[nodiscard]] bool predicted(int cv) const {
    return predicted_[static_cast<std::size_t>(cv)].comes;
  }
  /// They came, and do no longer.
  [[nodiscard]] bool ceased(int cv) const {
    const Predicted& predicted = predicted_[static_cast<std::size_t>(cv)];
    return predicted.came && !predicted.comes;
  }
  /// A historian has compressed the CV.
  [[nodiscard]] bool compressed(int cv) const {
    return compression_[static_cast<std::size_t>(cv)].kind() != Compression::Kind::kNone;
  }
  /// What the values of an input look like. (Lines in it may be ramps.)
  [[nodiscard]] const Compression& input_compression(int input) const {
    return input_compression_[static_cast<std::size_t>(input)];
  }
  /// Whether too few values have come to know the usual range of the CV, or of what its residual is
  /// made from: its predictions or, where none come, the inputs that act on it.
  [[nodiscard]] bool learns(int cv) const;
  /// Share of a coarse CV's values that repeat the one before, 0..1; 0 of a fine one.
  [[nodiscard]] double repeated_share(int cv) const;
  /// Spikes of one CV so far.
  [[nodiscard]] std::uint64_t spikes(int cv) const {
    return jumps_[static_cast<std::size_t>(cv)].spikes;
  }

  void archive(Archive& a);

 private:
  /// One signal's repetitions.
  struct Repeats {
    double last = 0.0, before_last = 0.0;
    int run = 0;      // values in a row equal to the one before
    int returns = 0;  // to the value before the last
    double repeated = calibration::repeats::kPriorRepeated;
    double counted = calibration::repeats::kPriorValues;
    double low = 0.0, high = 0.0;
    int at_low = 0, at_high = 0;  // how often exactly there
    int taken = 0;
    bool may_be_held = false;  // an input
    void take(double value);
    void forget_ends();  // that were none of the process
    [[nodiscard]] bool coarse() const { return returns >= calibration::repeats::kReturns; }
    [[nodiscard]] bool frozen() const;
    [[nodiscard]] bool at_end() const;
    void archive(Archive& a);
  };
  /// One CV's residual (or measurement) for spikes.
  struct Jumps {
    double scale = 0.0;  // of the differences
    double samples = 0.0;
    double home = 0.0;   // last level that left without a mark
    double moved = 0.0;  // by which it differed from the one before it
    int since_home = 0;  // frames
    std::uint64_t spikes = 0;
    void archive(Archive& a);
  };
  /// One signal's range.
  struct Range {
    Extent extent;
    int far = 0;    // values in a row that are absurdly far outside
    Extent former;  // where it was before it stayed there
    bool left = false;
    int out = 0;          // frames of an excursion
    double last = 0.0;    // value
    bool taken = false;   // some of it has left the screen
    int rejected = 0;     // excursions that came back
    double pulses = 0.0;  // of an input, lately
    // Where the last values are that lie close together for what it has ranged:
    double low = 0.0, high = 0.0;
    int close = 0;           // so many
    int moved = 0;           // that differ from the one before
    double came_from = 0.0;  // the one before the first of them
    int values = 0;          // since it began anew, until kFirstPhase
    void archive(Archive& a);
  };
  [[nodiscard]] std::size_t place(int frames) const {
    return static_cast<std::size_t>((position_ + kHeld - frames) % kHeld);
  }
  [[nodiscard]] Frame& ago(int frames) { return ring_[place(frames)]; }
  /// Whether predictions of one CV come.
  struct Predicted {
    bool comes = false;
    bool came = false;  // ever
    int against = 0;    // frames in a row that say otherwise
    void archive(Archive& a);
  };
  void follow_predictions(const SignalBlock& predictions);
  void follow_inputs();
  void follow_compression_of_inputs();
  [[nodiscard]] bool may_rest(SignalKind kind, int index) const;
  void screen_repeats();
  void screen_repeats(SignalKind kind);
  void mark(SignalKind kind, int index, int frames, std::uint64_t ScreenCounters::*counter);
  void screen_spikes(int cv);
  void screen_pulses(SignalKind kind);
  [[nodiscard]] int far_signals() const;
  void screen_far(SignalKind kind);
  [[nodiscard]] std::span<const SignalKind> screened() const;
  [[nodiscard]] bool absurd(SignalKind kind, int index, Range& range);
  void follow_excursion(SignalKind kind, int index, Range& range);
  void mark_isolated(SignalKind kind, int index, const Range& range, int first);
  void reject_excursion(SignalKind kind, int index, Range& range);
  void forget_jumps(SignalKind kind, int index);
  void end_excursion(SignalKind kind, int index, Range& range);
  void learn_range(SignalKind kind);
  void learn_first(SignalKind kind, int index, Range& range);
  [[nodiscard]] static bool began_wild(Range& range, double value);
  [[nodiscard]] bool level(int cv, int frames, double& value);

  SignalCounts counts_;
  std::vector<bool> may_predict_;
  std::vector<Predicted> predicted_;  // per CV
  std::vector<bool> acts_;
  int dead_time_;
  int turning_;
  Looks looks_;
  bool inputs_matter_ = true;
  bool all_mvs_rest_ = true;
  std::vector<int> since_rest_;  // per input, samples
  std::vector<Frame> ring_;
  std::vector<ScreenCounters> marked_;  // of the same frames
  int position_ = 0;
  int held_ = 0;    // frames that have not left
  int pushed_ = 0;  // frames, until there are enough to judge one by those after it
  int longest_out_ = 0;
  bool run_ended_ = false;
  bool anew_ = false;
  bool one_is_far_ = false;                    // of the last frame
  std::vector<std::vector<Repeats>> repeats_;  // per kind
  std::vector<std::vector<Range>> ranges_;     // per kind
  std::vector<Jumps> jumps_;                   // per CV
  std::vector<Compression> compression_;       // per CV
  std::vector<Compression> input_compression_;
  std::vector<bool> read_seldom_;  // per CV
  ScreenCounters counters_;
};

}  // namespace mpm
