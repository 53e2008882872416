#include "core/signal/aligner.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/archive/archive.hpp"

namespace mpm {
namespace {

using calibration::alignment::kLargestInterval;
using calibration::alignment::kLongestGap;

unsigned bit_of(SignalKind kind) { return 1u << static_cast<unsigned>(kind); }

Quality quality_of(std::uint8_t code) {
  return code <= static_cast<std::uint8_t>(Quality::kBad) ? static_cast<Quality>(code)
                                                          : Quality::kBad;
}

void make_bad(SignalBlock& block) {
  block.values.setConstant(std::numeric_limits<double>::quiet_NaN());
  std::fill(block.quality.begin(), block.quality.end(), Quality::kBad);
}

}  // namespace

Aligner::Aligner(const SignalCounts& counts, const std::array<bool, kSignalKindCount>& needed,
                 Sink sink, const AlignerSettings& settings)
    : counts_(counts), settings_(settings), sink_(std::move(sink)) {
  settings_.capacity = std::max(settings_.capacity, 2 * settings_.max_lateness + 2);
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    (needed[kind] ? needed_ : welcome_) |=
        needed[kind] || settings_.welcome[kind] ? 1u << kind : 0u;
  Slot empty;
  empty.frame = Frame(counts);
  current_.slots.assign(static_cast<std::size_t>(settings_.capacity), empty);
  candidate_.slots = current_.slots;
}

void Aligner::push(const BlockView& block) {
  if ((taken() & bit_of(block.kind)) == 0) return;
  const auto count = static_cast<std::size_t>(counts_.of(block.kind));
  if (block.values.size() != count || (!block.quality.empty() && block.quality.size() != count)) {
    ++counters_.wrong_length;
    return;
  }
  if (block.interval > kLargestInterval || block.interval < -kLargestInterval) {
    ++counters_.beyond;
    return;
  }
  if (!current_.started) start(current_, block.interval);
  if (near(current_, block.interval) && !goes_back(block)) {
    store(current_, block);
    if (current_.newest_of[static_cast<std::size_t>(block.kind)] == block.interval)
      go_on(block.kind);
    advance();
    return;
  }
  if (!candidate_.started || !near(candidate_, block.interval)) start(candidate_, block.interval);
  if (store(candidate_, block) && ++candidate_frames_ >= calibration::alignment::kReturnFrames)
    take_over();
}

bool Aligner::goes_back(const BlockView& block) {
  const unsigned bit = bit_of(block.kind);
  const auto kind = static_cast<std::size_t>(block.kind);
  if ((current_.seen & bit) == 0 || block.source_time_ns <= current_.time_of[kind]) return false;
  const std::int64_t newest = current_.newest_of[kind];
  if ((back_ & bit) != 0) {
    // Beyond both, it counts on from the one that is nearer.
    return block.interval <= newest || candidate_.newest_of[kind] >= newest;
  }
  if (block.interval > newest - calibration::alignment::kSmallestReturn) return false;
  if (back_ == 0) start(candidate_, block.interval);
  back_ |= bit;
  return true;
}

// With the numbers that it had: what came of others is none of a restart's. Each kind says so by
// its own blocks, whichever topic is read first.
void Aligner::go_on(SignalKind kind) {
  const unsigned bit = bit_of(kind);
  if (!candidate_.started || (candidate_.seen & bit) == 0) return;
  for (std::int64_t k = candidate_.next; k <= candidate_.newest; ++k) {
    Slot& slot = slot_of(candidate_, k);
    if (!slot.used || slot.interval != k || (slot.present & bit) == 0) continue;
    slot.present &= ~bit;
    slot.used = slot.present != 0;
    refuse(k, kind);
  }
  candidate_.seen &= ~bit;
  back_ &= ~bit;
  candidate_frames_ = 0;
}

void Aligner::refuse(std::int64_t interval, SignalKind kind) {
  const Slot& settled = slot_of(current_, interval);
  const bool was_there =
      settled.used && settled.interval == interval && (settled.present & bit_of(kind)) != 0;
  ++(was_there ? counters_.repeated : counters_.late);
}

void Aligner::Slot::archive(Archive& a) { a(frame, interval, present, used); }

// What is between the first that is not settled and the newest has a place each.
void Aligner::Window::archive(Archive& a) {
  a(slots, newest_of, seen, next, newest, started);
  for (std::int64_t& time : time_of) a.time(time);
  a.require(next - newest <= 1 && newest - next < static_cast<std::int64_t>(slots.size()),
            "a window that its intervals do not fit");
}

void Aligner::archive(Archive& a) {
  // not archived: counts_, settings_, sink_, needed_, welcome_ (construction)
  // not archived: restart_ (told at once)
  a(silent_, current_, candidate_, back_, candidate_frames_, elsewhere_, offset_, last_emitted_,
    restarted_, counters_);
  a.time(last_time_ns_);
}

bool Aligner::deserted() const {
  const int kinds = std::popcount(candidate_.seen);
  return candidate_.started && kinds > 0 &&
         elsewhere_ >= static_cast<std::uint64_t>(calibration::alignment::kReturnFrames * kinds);
}

void Aligner::expire() {
  if (!current_.started) return;
  if (deserted()) take_over();
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind) {
    const unsigned bit = 1u << kind;
    const bool behind = (current_.seen & bit) == 0 ||
                        current_.newest_of[kind] < current_.newest - settings_.max_lateness;
    if ((taken() & bit) != 0 && behind) silent_ |= bit;
  }
  std::int64_t last_complete = current_.newest;
  while (last_complete >= current_.next && !complete(last_complete)) --last_complete;
  while (current_.next <= last_complete) settle_next(current_);
  advance();
}

void Aligner::finish() {
  if (deserted()) take_over();
  while (unsettled()) settle_next(current_);
}

void Aligner::start(Window& window, std::int64_t interval) {
  for (Slot& slot : window.slots) {
    if (slot.used && &window == &candidate_)  // never got into a frame
      counters_.late += static_cast<std::uint64_t>(std::popcount(slot.present));
    slot.used = false;
  }
  if (&window == &candidate_) {
    back_ = 0;
    candidate_frames_ = 0;
    elsewhere_ = 0;
  }
  window.seen = 0;
  // Blocks of earlier intervals may still be on their way.
  window.next = interval - settings_.max_lateness;
  window.newest = interval;
  window.started = true;
}

bool Aligner::near(const Window& window, std::int64_t interval) const {
  return interval >=
             window.next - calibration::alignment::kRestartFactor * settings_.max_lateness &&
         interval <= window.newest + settings_.capacity;
}

std::size_t Aligner::place_of(std::int64_t interval) const {
  const std::int64_t size = settings_.capacity;
  return static_cast<std::size_t>(((interval % size) + size) % size);
}

Aligner::Slot& Aligner::slot_of(Window& window, std::int64_t interval) const {
  return window.slots[place_of(interval)];
}

bool Aligner::store(Window& window, const BlockView& block) {
  const unsigned bit = bit_of(block.kind);
  if (block.interval < window.next) {
    refuse(block.interval, block.kind);
    return false;
  }
  while (block.interval >= window.next + settings_.capacity) settle_next(window);

  Slot& slot = slot_of(window, block.interval);
  if (!slot.used || slot.interval != block.interval) {
    slot.used = true;
    slot.interval = block.interval;
    slot.present = 0;
    slot.frame.source_time_ns = block.source_time_ns;
    for (SignalBlock& absent : slot.frame.blocks) make_bad(absent);
  }
  if ((slot.present & bit) != 0) {
    ++counters_.repeated;
    return false;
  }
  fill(slot, block);
  elsewhere_ = &window == &candidate_ ? elsewhere_ + 1 : 0;

  std::int64_t& newest_of_kind = window.newest_of[static_cast<std::size_t>(block.kind)];
  const bool seen = (window.seen & bit) != 0;
  const bool adjacent = seen && block.interval == newest_of_kind + 1;
  if (seen && block.interval < newest_of_kind) ++counters_.out_of_order;
  if (!seen || block.interval > newest_of_kind) {
    newest_of_kind = block.interval;
    window.time_of[static_cast<std::size_t>(block.kind)] = block.source_time_ns;
  }
  window.newest = std::max(window.newest, block.interval);
  window.seen |= bit;
  if (&window == &current_ && (adjacent || (needed_ & bit) != 0)) silent_ &= ~bit;
  return (needed_ & bit) != 0 && (slot.present & needed_) == needed_;
}

void Aligner::fill(Slot& slot, const BlockView& block) {
  SignalBlock& target = slot.frame[block.kind];
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    const bool finite = std::isfinite(block.values[i]);
    if (!finite) ++counters_.non_finite;
    if (std::isinf(block.values[i])) ++counters_.infinite;
    target.values(static_cast<Eigen::Index>(i)) = block.values[i];
    target.quality[i] = !finite                 ? Quality::kBad
                        : block.quality.empty() ? Quality::kGood
                                                : quality_of(block.quality[i]);
  }
  // Kinds of one interval may be sampled at slightly different times; the last one is when all
  // was known, whatever came first.
  slot.frame.source_time_ns = std::max(slot.frame.source_time_ns, block.source_time_ns);
  slot.present |= bit_of(block.kind);
}

void Aligner::settle_next(Window& window) {
  Slot& slot = slot_of(window, window.next);
  const bool something = slot.used && slot.interval == window.next;
  if (something && &window == &current_) emit(slot);
  if (something && &window == &candidate_) {
    counters_.late += static_cast<std::uint64_t>(std::popcount(slot.present));
    slot.used = false;
  }
  ++window.next;
}

void Aligner::emit(Slot& slot) {
  const std::int64_t interval = slot.interval + offset_;
  if (counters_.frames > 0) counters_.missing += missing_before(interval, slot.frame);
  ++counters_.frames;
  const unsigned absent = needed_ & ~slot.present;
  if (absent != 0) ++counters_.incomplete;
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    if ((absent & 1u << kind) != 0) ++counters_.without[kind];
  restarted_ = false;
  last_emitted_ = interval;
  last_time_ns_ = slot.frame.source_time_ns;
  slot.frame.interval = interval;
  sink_(slot.frame);
}

std::uint64_t Aligner::missing_before(std::int64_t interval, const Frame& frame) const {
  const auto left_out = static_cast<double>(interval - last_emitted_ - 1);
  // Times may be anything: no difference of extremes.
  const double elapsed_ns =
      static_cast<double>(frame.source_time_ns) - static_cast<double>(last_time_ns_);
  if (settings_.sample_time_ns <= 0.0 || (elapsed_ns == 0.0 && !restarted_))  // it has no clock
    return static_cast<std::uint64_t>(left_out);
  const double room = std::max(0.0, std::round(elapsed_ns / settings_.sample_time_ns) - 1.0);
  const bool leapt = left_out > room + calibration::alignment::kMaxLateness;  // times jitter
  return static_cast<std::uint64_t>(leapt || restarted_ ? std::min(room, left_out) : left_out);
}

bool Aligner::complete(std::int64_t interval) const {
  const Slot& slot = current_.slots[place_of(interval)];
  const unsigned awaited = needed_ | (welcome_ & ~silent_);
  return slot.used && slot.interval == interval && (slot.present & awaited) == awaited;
}

void Aligner::advance() {
  while (unsettled() && (complete(current_.next) || past_lateness(current_.next)))
    settle_next(current_);
}

bool Aligner::past_lateness(std::int64_t interval) const {
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind) {
    const unsigned bit = 1u << kind;
    if ((taken() & ~silent_ & bit) == 0) continue;
    if ((current_.seen & bit) == 0) return false;
    if (current_.newest_of[kind] <= interval + settings_.max_lateness) return false;
  }
  return true;
}

// Of what is there.
std::int64_t Aligner::first_of(Window& window) const {
  std::int64_t first = window.next;
  while (first < window.newest && !slot_of(window, first).used) ++first;
  return first;
}

void Aligner::take_over() {
  while (unsettled()) settle_next(current_);
  const std::int64_t next = candidate_.next + offset_;
  if (counters_.frames > 0 &&
      (next <= last_emitted_ || next - last_emitted_ > kLongestGap || next > kLargestInterval)) {
    ++counters_.restarts;
    restarted_ = true;
    restart_ = {current_.newest, first_of(candidate_)};
    offset_ = last_emitted_ + 2 - candidate_.next;  // 2: never adjacent, so that windows close
  }
  std::swap(current_, candidate_);
  candidate_.started = false;
  elsewhere_ = 0;
  for (Slot& slot : candidate_.slots) slot.used = false;
  back_ = 0;
  candidate_frames_ = 0;
  silent_ &= welcome_;  // of which a new beginning says nothing
  advance();
}

}  // namespace mpm
