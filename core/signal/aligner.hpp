#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/signal/calibration.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

class Archive;

/// Values of one kind at one interval, as they come in.
struct BlockView {
  SignalKind kind = SignalKind::kMv;
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::span<const double> values;
  std::span<const std::uint8_t> quality;  ///< codes of `Quality`, others count as bad; empty = good
};

struct AlignerSettings {
  /// Intervals that a block may come after all kinds had newer ones.
  int max_lateness = calibration::alignment::kMaxLateness;
  /// Intervals that one kind may be ahead of another one, > max_lateness.
  int capacity = calibration::alignment::kCapacity;
  /// Kinds that frames take along besides those that they need: awaited while they come, missed by
  /// nobody where they do not.
  std::array<bool, kSignalKindCount> welcome{};
  /// Of more intervals than the source times had room for none is missing: the numbers leapt. 0:
  /// the numbers are believed.
  double sample_time_ns = 0.0;
};

/// What became of the blocks and intervals so far.
struct AlignerCounters {
  std::uint64_t frames = 0;        ///< emitted
  std::uint64_t incomplete = 0;    ///< of these: with a needed block absent
  std::uint64_t missing = 0;       ///< intervals between emitted ones of which nothing came
  std::uint64_t late = 0;          ///< blocks whose interval was settled, or that fit nowhere
  std::uint64_t repeated = 0;      ///< blocks that were there already; the first one counts
  std::uint64_t out_of_order = 0;  ///< blocks that came after a newer one of their kind, in time
  std::uint64_t wrong_length = 0;  ///< blocks of another size
  std::uint64_t beyond = 0;        ///< blocks with an interval number beyond 2^53
  std::uint64_t non_finite = 0;    ///< values; they become bad
  std::uint64_t infinite = 0;      ///< of these: not just without a value
  std::uint64_t restarts = 0;      ///< the interval number went back to a new beginning
  /// Of the incomplete frames those without the block of a kind.
  std::array<std::uint64_t, kSignalKindCount> without{};

  template <class Archive>
  void archive(Archive& a) {
    a(frames, incomplete, missing, late, repeated, out_of_order, wrong_length, beyond, non_finite,
      infinite, restarts, without);
  }
};

/// Puts the blocks of one unit, which come in any order across kinds, together into one frame per
/// control interval, in increasing order. Knows no clock: only interval numbers decide.
///
/// An interval is settled, i.e. its frame is emitted and nothing more is accepted for it, when all
/// intervals before it are settled and
///   - all blocks that are awaited are there, or
///   - every kind that is awaited has gone on to an interval more than `max_lateness` newer, or
///   - some kind is `capacity` intervals ahead, or
///   - `expire()` says that a kind has fallen silent, or that what came last waits for too long.
/// A needed kind is awaited until `expire()` finds it silent, and again once it comes; so is a
/// welcome one, but again only once it comes in adjacent intervals: what is sent now and then holds
/// up no frame. Absent blocks of an emitted frame are bad and have no value; an interval of which
/// nothing came is left out. So as long as blocks come no more than `max_lateness` intervals late,
/// the frames depend on what came and not on its order. The first frame after a start waits for the
/// lateness to pass, or for `expire()`.
///
/// Blocks far from the current window are gathered in a second one. When that one has kReturnFrames
/// complete frames and no kind of theirs went on with its old numbers, it takes over: the
/// controller restarted or was away. So it does in `expire()` where no frame in it is complete, as
/// without a kind that has fallen silent meanwhile, and all that comes has come there. So a stray
/// number changes nothing, be it one block's or a whole interval's. After a restart the emitted
/// interval numbers go on increasing, with a gap; so they do after a leap forward that would take
/// them beyond 2^53.
class Aligner {
 public:
  using Sink = std::function<void(const Frame&)>;

  /// `needed[kind]`: frames wait for that kind; blocks of other kinds that are not welcome are
  /// ignored.
  /// `sink` gets each frame from inside `push` or `expire`; it is valid during the call.
  Aligner(const SignalCounts& counts, const std::array<bool, kSignalKindCount>& needed, Sink sink,
          const AlignerSettings& settings = {});

  void push(const BlockView& block);

  /// For the caller that has a clock, when nothing was emitted for too long: what lies before a
  /// complete frame is not awaited any longer; nor are, until they come again, kinds that are
  /// behind by more than the lateness.
  void expire();

  /// Emits all that is there, for the caller that knows that nothing more will come.
  void finish();

  /// True while something waits for its frame to be complete.
  [[nodiscard]] bool pending() const { return unsettled() || deserted(); }
  [[nodiscard]] const AlignerCounters& counters() const { return counters_; }
  /// The last one, in numbers as they came: the newest before it, the first after it.
  struct Restart {
    std::int64_t from = 0, to = 0;
  };
  [[nodiscard]] const Restart& restart() const { return restart_; }

  void archive(Archive& a);

 private:
  struct Slot {
    Frame frame;
    std::int64_t interval = 0;
    unsigned present = 0;  // bit per kind; kept after settling, to recognise repetitions
    bool used = false;
    void archive(Archive& a);
  };
  struct Window {
    std::vector<Slot> slots;                                 // ring, by interval
    std::array<std::int64_t, kSignalKindCount> newest_of{};  // per kind
    std::array<std::int64_t, kSignalKindCount> time_of{};    // of that one, source time
    unsigned seen = 0;                                       // kinds that came at all
    std::int64_t next = 0;                                   // first unsettled interval
    std::int64_t newest = 0;
    bool started = false;
    void archive(Archive& a);
  };

  void start(Window& window, std::int64_t interval);
  /// True if the block is for the second window, though it is near the first.
  [[nodiscard]] bool goes_back(const BlockView& block);
  void go_on(SignalKind kind);
  void refuse(std::int64_t interval, SignalKind kind);
  [[nodiscard]] bool unsettled() const {
    return current_.started && current_.next <= current_.newest;
  }
  /// The second window alone has been filled lately, and by more than stray numbers.
  [[nodiscard]] bool deserted() const;
  [[nodiscard]] bool near(const Window& window, std::int64_t interval) const;
  [[nodiscard]] std::size_t place_of(std::int64_t interval) const;
  [[nodiscard]] Slot& slot_of(Window& window, std::int64_t interval) const;
  /// Stores the block; true if it completed its frame.
  bool store(Window& window, const BlockView& block);
  void fill(Slot& slot, const BlockView& block);
  void settle_next(Window& window);
  [[nodiscard]] bool complete(std::int64_t interval) const;
  void emit(Slot& slot);
  [[nodiscard]] std::uint64_t missing_before(std::int64_t interval, const Frame& frame) const;
  void advance();
  [[nodiscard]] std::int64_t first_of(Window& window) const;
  void take_over();
  [[nodiscard]] bool past_lateness(std::int64_t interval) const;

  SignalCounts counts_;
  AlignerSettings settings_;
  Sink sink_;
  [[nodiscard]] unsigned taken() const { return needed_ | welcome_; }

  unsigned needed_ = 0;
  unsigned welcome_ = 0;  // and not needed
  unsigned silent_ = 0;   // kinds of these that nobody waits for
  Window current_;
  Window candidate_;
  unsigned back_ = 0;              // kinds whose numbers went back a little, into the candidate
  int candidate_frames_ = 0;       // complete there since a kind went on
  std::uint64_t elsewhere_ = 0;    // blocks in the candidate since the last one in the other
  std::int64_t offset_ = 0;        // emitted minus received interval number
  std::int64_t last_emitted_ = 0;  // valid if counters_.frames > 0
  std::int64_t last_time_ns_ = 0;  // likewise, source time
  bool restarted_ = false;         // since that one: the gap in the numbers is this class's own
  AlignerCounters counters_;
  Restart restart_;
};

}  // namespace mpm
