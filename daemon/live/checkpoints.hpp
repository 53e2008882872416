#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/archive/archive.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/live/sample_log.hpp"
#include "daemon/live/state_files.hpp"
#include "daemon/live/unit_samples.hpp"

namespace mpm::live {

/// What one unit keeps for the process after this one: the samples that it takes, and every so many
/// of them all that they have made of it, so that few are to be judged again. A state is copied
/// while nothing waits, and let be as soon as something does: it costs no sample more than the
/// megabyte that is at hand. Only where nothing ever rests, for twice as long as between two
/// states, does it keep one waiting.
class Checkpoints {
 public:
  /// `unit`: for the log. `archive`: the state's listing; must outlive this, as what it lists.
  Checkpoints(const UnitSamples& samples, std::string unit, std::function<void(Archive&)> archive);

  /// Takes the last state that fits, for which the listing is as construction made it. Then
  /// `recall`, before all others. False: there is none, and all is as before.
  [[nodiscard]] bool take_back();
  /// The samples behind that state go to `visit`, those before it to `earlier`, where that is any.
  /// What of them is not used is logged, and why.
  void recall(const SampleLog::Visit& visit, const SampleLog::Visit& earlier);
  /// As things stand after `recall`, which took long: from now on this is the state.
  void keep_now();

  /// Before it is acted upon. Never throws for the disk: see `problem`.
  void push(const BlockView& block);
  void push_expiry() { log_.push_expiry(); }
  /// What samples do not tell has changed: a state is due.
  void want_state() { wanted_ = true; }
  /// Nothing waits, until `disturbed` says otherwise. True where a state was begun.
  bool rest(const std::function<bool()>& disturbed);
  /// Looks what has become of the one before.
  void poll();

  [[nodiscard]] const std::string& folder() const { return log_.folder(); }
  /// Why nothing can be kept now; empty: it can.
  [[nodiscard]] const std::string& problem() const {
    return log_.problem().empty() ? states_.problem() : log_.problem();
  }

 private:
  bool keep_before(std::uint64_t file);

  std::string unit_;
  std::function<void(Archive&)> archive_;
  std::uint64_t files_between_states_;
  SampleLog log_;
  StateFiles states_;
  std::uint64_t taken_back_ = 0;  // the file behind it; 0: none
  std::uint64_t next_state_ = 1;  // the file
  bool wanted_ = false;
};

}  // namespace mpm::live
