#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"
#include "daemon/bus/input_stream.hpp"
#include "daemon/bus/trouble.hpp"
#include "idl/discovery.hpp"
#include "idl/participant.hpp"
#include "mpm.h"

namespace mpm::bus {

/// What should come of a unit.
struct ExpectedInputs {
  std::string unit;
  double sample_time_s = 1.0;
  SignalCounts counts;
  std::array<bool, kSignalKindCount> needed{};
  std::array<bool, kSignalKindCount> welcome{};  ///< besides, taken where they come
  /// So long may a topic say nothing.
  std::chrono::steady_clock::duration silence = std::chrono::seconds(5);
  /// What layouts are compared with; nothing: with nothing.
  std::optional<config::UnitConfig> file;
};

/// By a unit file; `needed`: files::needed_kinds of it, `welcome`: files::aligner_settings'.
[[nodiscard]] ExpectedInputs expected_inputs(const config::UnitConfig& unit,
                                             const std::array<bool, kSignalKindCount>& needed,
                                             const std::array<bool, kSignalKindCount>& welcome);

/// What else is known of the domain that a unit is on.
struct Surroundings {
  std::string place;                     ///< "domain 3, partition 'a'"
  std::string self;                      ///< this process, as idl::name_of
  std::vector<idl::Endpoint> endpoints;  ///< of others; an outdated list only costs a name
  /// Units whose samples come though no unit file has them, each with a writer of it.
  std::map<std::string, std::uint64_t> strangers;
};
/// Null where it is not known.
[[nodiscard]] const idl::Endpoint* find_writer(const Surroundings& around, std::uint64_t handle);
/// Its process, as idl::name_of.
[[nodiscard]] std::string writer_name(const Surroundings& around, std::uint64_t handle);
/// "domain 3", "domain 3, partition 'a'"; and that CYCLONEDDS_URI is set in vain.
[[nodiscard]] std::string place_text(const idl::DomainOptions& domain);

/// How the trouble begins that nothing has come of a unit since who looks began to.
inline constexpr const char* kNothingCame = "no data has come";

/// How the samples of one unit come, and everything that is wrong with that. The same judgement
/// for the daemon, which says it on mpm/health, and for `mpm doctor`.
class UnitInputs {
 public:
  using Clock = std::chrono::steady_clock;

  UnitInputs(ExpectedInputs expected, Clock::time_point now)
      : expected_(std::move(expected)), start_(now) {}

  void push(SignalKind kind, const Arrival& arrival, Clock::time_point now);
  /// What the control system says its values are, or that `writer` says it of `kind` no more.
  void hear(const mpm_Layout& layout, std::uint64_t writer);
  void forget_layout(const char* kind, std::uint64_t writer);
  /// This process stood still until now: what was missed meanwhile is no fault of the inputs.
  void stood_still(Clock::time_point now) { resumed_ = now; }
  /// Only now, after a long start, is anything taken.
  void begin(Clock::time_point now) { start_ = now; }
  /// A process before this one has had samples: that none come is no beginning.
  void recall() { recalled_ = true; }
  /// The worst first. What only happens once is told for a minute.
  [[nodiscard]] std::vector<Trouble> troubles(const Surroundings& around,
                                              Clock::time_point now) const;
  /// True while `troubles` could use a fresh list of endpoints.
  [[nodiscard]] bool wants_endpoints(Clock::time_point now) const;

  [[nodiscard]] const ExpectedInputs& expected() const { return expected_; }
  void expect(ExpectedInputs expected) { expected_ = std::move(expected); }
  [[nodiscard]] const InputStream& stream(SignalKind kind) const {
    return streams_[static_cast<std::size_t>(kind)];
  }

 private:
  [[nodiscard]] bool needed(SignalKind kind) const;
  [[nodiscard]] bool welcome(SignalKind kind) const;
  [[nodiscard]] bool silent(SignalKind kind, Clock::time_point now) const;
  [[nodiscard]] bool has_stopped(SignalKind kind, Clock::time_point now) const;
  [[nodiscard]] std::string why_silent(SignalKind kind, const Surroundings& around,
                                       Clock::time_point now) const;
  void add_silence(const Surroundings& around, Clock::time_point now,
                   std::vector<Trouble>& troubles) const;
  void add_rivals(const Surroundings& around, Clock::time_point now,
                  std::vector<Trouble>& troubles) const;
  void add_layouts(const Surroundings& around, std::vector<Trouble>& troubles) const;
  void add_gaps(Clock::time_point now, std::vector<Trouble>& troubles) const;
  void add_contents(Clock::time_point now, std::vector<Trouble>& troubles) const;
  void add_events(Clock::time_point now, std::vector<Trouble>& troubles) const;
  [[nodiscard]] bool clock_off(SignalKind kind, Clock::time_point now) const;
  void add_clock_offset(const Surroundings& around, Clock::time_point now,
                        std::vector<Trouble>& troubles) const;

  ExpectedInputs expected_;
  Clock::time_point start_;
  std::optional<Clock::time_point> resumed_;
  bool recalled_ = false;
  std::map<std::pair<std::string, std::uint64_t>, std::string> wrong_layouts_;  // kind, writer
  std::array<InputStream, kSignalKindCount> streams_;
};

}  // namespace mpm::bus
