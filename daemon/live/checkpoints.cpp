#include "daemon/live/checkpoints.hpp"

#include <spdlog/spdlog.h>

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace mpm::live {

Checkpoints::Checkpoints(const UnitSamples& samples, std::string unit,
                         std::function<void(Archive&)> archive)
    : unit_(std::move(unit)),
      archive_(std::move(archive)),
      files_between_states_(samples.files_between_states),
      log_(samples.folder, samples.meaning, samples.keep),
      states_(samples.folder, samples.owner) {}

bool Checkpoints::take_back() {
  std::vector<std::byte> constructed;
  Archive away(constructed);
  archive_(away);
  states_.expect(constructed.size());
  for (const std::uint64_t file : states_.find(log_.files())) {
    std::string why;
    const std::optional<std::vector<std::byte>> bytes = states_.read(file, why);
    if (!bytes) {
      spdlog::log(why == StateFiles::kBelongsElsewhere ? spdlog::level::info : spdlog::level::warn,
                  "{}: {} is not used: {}", unit_, states_.path(file), why);
      continue;
    }
    try {
      Archive back{std::span(*bytes)};
      archive_(back);
      back.require(back.left() == 0, "more bytes than belong there");
      states_.expect(bytes->size());
      taken_back_ = file;
      break;
    } catch (const std::runtime_error& error) {
      spdlog::warn("{}: {} is not used: {}", unit_, states_.path(file), error.what());
      Archive back{std::span(constructed)};
      archive_(back);
    }
  }
  log_.hold_from(states_.oldest());
  return taken_back_ > 0;
}

void Checkpoints::recall(const SampleLog::Visit& visit, const SampleLog::Visit& earlier) {
  const std::string lost = log_.recall(visit, taken_back_, earlier);
  if (!lost.empty())
    spdlog::log(lost == SampleLog::kChanged ? spdlog::level::info : spdlog::level::warn,
                "{}: not all samples that were kept are used: {}", unit_, lost);
  next_state_ = log_.last() + 1;
}

void Checkpoints::keep_now() {
  if (const std::optional<std::uint64_t> begun = log_.begin_next()) (void)keep_before(*begun);
}

void Checkpoints::push(const BlockView& block) {
  const std::optional<std::uint64_t> begun = log_.push(block);
  if (!begun) return;
  poll();
  if (*begun >= next_state_ + files_between_states_) (void)keep_before(*begun);
}

// Nothing of that file has been acted upon: what it holds comes behind the state.
bool Checkpoints::keep_before(std::uint64_t file) {
  return states_.keep([&](std::vector<std::byte>& bytes) {
    Archive away(bytes);
    archive_(away);
    next_state_ = file + files_between_states_;
    return std::optional(file);
  });
}

bool Checkpoints::rest(const std::function<bool()>& disturbed) {
  if (!wanted_ && (log_.last() + 1 < next_state_ || !log_.full())) return false;
  return states_.keep([&](std::vector<std::byte>& bytes) -> std::optional<std::uint64_t> {
    try {
      Archive away(bytes, disturbed);
      archive_(away);
    } catch (const Archive::Stopped&) {
      return std::nullopt;
    }
    const std::optional<std::uint64_t> begun = log_.begin_next();
    if (begun) next_state_ = *begun + files_between_states_;
    wanted_ = false;
    return begun;
  });
}

void Checkpoints::poll() {
  states_.poll();
  log_.hold_from(states_.oldest());
}

}  // namespace mpm::live
