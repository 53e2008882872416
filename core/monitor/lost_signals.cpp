#include "core/monitor/lost_signals.hpp"

#include <cmath>

#include "core/archive/archive.hpp"

namespace mpm {
namespace {

namespace bad_data = calibration::bad_data;

LossCause cause_of(const SignalBlock& block, int index) {
  if (!std::isfinite(block.values(index))) return LossCause::kNoValue;
  return block.quality[static_cast<std::size_t>(index)] == Quality::kBad ? LossCause::kQuality
                                                                         : LossCause::kImplausible;
}

}  // namespace

LostSignals::LostSignals(const SignalCounts& counts, int lags)
    : step_(1.0 / (bad_data::kLossSamples + lags)) {
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    losses_[kind].resize(static_cast<std::size_t>(counts.of(static_cast<SignalKind>(kind))));
}

void LostSignals::take(const Frame& frame, SignalKind kind, int index, bool usable) {
  const SignalBlock& block = frame[kind];
  Loss& loss = losses_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(index)];
  loss.share += step_ * ((usable ? 0.0 : 1.0) - loss.share);
  if (!usable) {
    loss.cause = cause_of(block, index);
    if (loss.usable && !loss.lost) loss.since_ns = frame.source_time_ns;
    loss.last_ns = frame.source_time_ns;
  }
  loss.usable = usable;
  loss.lost = loss.share > (loss.lost ? bad_data::kFoundShare : bad_data::kMostShare);
}

void LostSignals::Loss::archive(Archive& a) {
  a(share, usable, lost);
  a.within(cause, LossCause::kNoValue, LossCause::kImplausible);
  a.time(since_ns);
  a.time(last_ns);
}

void LostSignals::archive(Archive& a) {
  // not archived: step_ (construction)
  a(losses_);
}

std::vector<LostSignal> LostSignals::list() const {
  std::vector<LostSignal> lost;
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv, SignalKind::kPrediction}) {
    const std::vector<Loss>& losses = losses_[static_cast<std::size_t>(kind)];
    for (std::size_t i = 0; i < losses.size(); ++i)
      if (losses[i].lost)
        lost.push_back(
            {kind, static_cast<int>(i), losses[i].cause, losses[i].since_ns, losses[i].last_ns});
  }
  return lost;
}

}  // namespace mpm
