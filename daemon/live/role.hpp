#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "idl/discovery.hpp"
#include "idl/participant.hpp"
#include "idl/qos.hpp"
#include "idl/writer.hpp"

namespace mpm::live {

/// Which of several monitors of a unit speaks. All write to the unit's instance of mpm/role, and
/// all hear the strongest one that is alive (exclusive ownership, DDS 1.4, 2.2.3.9; liveliness
/// manual by topic, so a process that hangs is as good as dead): whoever hears himself speaks. Who
/// speaks is stronger than any who stands by, hence one that comes back stands by.
class Role {
 public:
  using Clock = std::chrono::steady_clock;
  /// Between two calls of `say` at most, five of which its word is good for.
  static constexpr std::chrono::milliseconds kPeriod = idl::kRoleLease / 5;
  static constexpr int kGreatestRank = 1000;

  /// `rank`: 0..kGreatestRank; of several that start together the greatest speaks.
  Role(const idl::Participant& participant, const std::string& unit, const idl::Process& self,
       int rank);

  /// Says that this process is there.
  void say(Clock::time_point now, std::int64_t wall_ns);
  /// What a reader of mpm/role took.
  void hear(const mpm_Role& sample, std::uint64_t writer);
  /// After what was heard; true where that changed whether this process speaks. In the first two
  /// seconds it does not, until the others are known.
  bool settle(Clock::time_point now, std::int64_t wall_ns);

  [[nodiscard]] bool active() const { return active_; }
  /// Who spoke last, as idl::name_of; empty: nobody yet.
  [[nodiscard]] const std::string& speaker() const { return speaker_; }

 private:
  void write() const;

  idl::Writer<mpm_Role> writer_;
  std::uint64_t self_;  // as in SampleInfo
  std::string unit_, host_;
  int process_, rank_;
  bool active_ = false;
  std::int64_t since_ns_ = 0;
  std::optional<Clock::time_point> listens_until_;
  std::uint64_t heard_ = 0;  // the writer that spoke last
  std::string speaker_;
};

}  // namespace mpm::live
