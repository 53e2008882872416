#include "daemon/bag/replay/player.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/signal/saturated.hpp"
#include "daemon/bag/replay/selection.hpp"

namespace mpm::bag {
namespace {

constexpr std::int64_t kLongestSleepNs = 50'000'000;
constexpr std::array kRates = {0.01, 0.02, 0.05, 0.1,  0.2,  0.5,  1.0,  2.0,
                               5.0,  10.0, 20.0, 50.0, 100., 200., 500., 1000.};

// The next step on the ladder; 0, no waiting, is above its end.
double faster(double rate) {
  if (rate == 0.0) return 0.0;
  const auto* next = std::upper_bound(kRates.begin(), kRates.end(), rate * 1.001);
  return next == kRates.end() ? 0.0 : *next;
}

double slower(double rate) {
  if (rate == 0.0) return kRates.back();
  const auto* here = std::lower_bound(kRates.begin(), kRates.end(), rate * 0.999);
  return here == kRates.begin() ? kRates.front() : *(here - 1);
}

}  // namespace

Player::Player(ReplaySource& source, host::Clock& clock, const PlayerOptions& options, Send send,
               NextKey next_key)
    : source_(source),
      clock_(clock),
      options_(options),
      send_(std::move(send)),
      next_key_(std::move(next_key)) {
  state_.rate = options.rate;
  state_.paused = options.start_paused;
}

bool Player::play() {
  do {
    if (!play_pass()) return false;
    if (quit_ || !options_.loop || !sent_any_) return true;  // an empty pass would spin
    ++state_.passes;
    shift_.next_pass();
    source_.rewind();
  } while (true);
}

bool Player::play_pass() {
  ReplaySample sample;
  pacer_.reset();
  sent_any_ = false;
  wait_for_start();
  while (!quit_ && source_.next(sample)) {
    if (!begin_ns_) begin_ns_ = sample.log_time_ns;
    if (is_over(options_, *begin_ns_, sample.log_time_ns)) return true;
    const std::string unit = idl::unit_of(sample.cdr);
    if (!selects(options_, *begin_ns_, sample.log_time_ns, unit)) continue;
    state_.recorded_ns = sample.log_time_ns - *begin_ns_;
    if (wait_for(sample.log_time_ns) == Wait::kQuit) return true;
    if (state_.passes == 0 && options_.loop) shift_.see(sample, unit);
    idl::SampleChange change = shift_.change_of(unit);
    if (state_.passes == 0) change = {};
    if (const auto to = options_.remap.find(unit); to != options_.remap.end())
      change.unit = to->second;
    if (!send_(sample, saturated_sum(sample.source_time_ns, shift_.time_shift_ns()), change))
      return false;
    ++state_.samples;
    sent_any_ = true;
  }
  return true;
}

// Only the key that quits counts here.
void Player::wait_for_start() {
  const std::int64_t start = clock_.now() + options_.delay_ns;
  for (std::int64_t now = clock_.now(); now < start && !quit_; now = clock_.now()) {
    quit_ = next_key_(state_) == Key::kQuit;
    clock_.sleep_until(std::min(start, now + kLongestSleepNs));
  }
}

Player::Wait Player::wait_for(std::int64_t log_time_ns) {
  if (!pacer_) {
    pacer_.emplace(state_.rate, log_time_ns, clock_.now());
    if (state_.paused) pacer_->pause(clock_.now());
  }
  while (true) {
    for (Key key = next_key_(state_); key != Key::kNone; key = next_key_(state_)) {
      const bool step = handle(key);
      if (quit_) return Wait::kQuit;
      if (!step) continue;
      pacer_->skip_to(log_time_ns);
      return Wait::kSend;
    }
    const std::int64_t now = clock_.now();
    const std::int64_t latest = now + kLongestSleepNs;
    if (pacer_->paused()) {
      clock_.sleep_until(latest);
      continue;
    }
    const std::int64_t due = pacer_->due(log_time_ns);
    if (due <= now) return Wait::kSend;
    clock_.sleep_until(std::min(due, latest));
  }
}

bool Player::handle(Key key) {
  const std::int64_t now = clock_.now();
  switch (key) {
    case Key::kPause:
      if (pacer_->paused())
        pacer_->resume(now);
      else
        pacer_->pause(now);
      break;
    case Key::kStep:
      return pacer_->paused();
    case Key::kFaster:
      pacer_->set_rate(faster(pacer_->rate()), now);
      break;
    case Key::kSlower:
      pacer_->set_rate(slower(pacer_->rate()), now);
      break;
    case Key::kQuit:
      quit_ = true;
      break;
    case Key::kNone:
      break;
  }
  state_.rate = pacer_->rate();
  state_.paused = pacer_->paused();
  return false;
}

}  // namespace mpm::bag
