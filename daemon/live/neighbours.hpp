#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bus/trouble.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/live/role.hpp"

namespace mpm::live {

/// Who else watches one unit: monitors that share it, of which one speaks, and monitors that speak
/// beside this one though nobody arranged it.
class Neighbours {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Neighbours(std::string unit) : unit_(std::move(unit)) {}

  /// From now on the unit is shared.
  void share(std::unique_ptr<Role> role, Clock::time_point now);
  /// Null: it is not.
  [[nodiscard]] Role* role() { return role_.get(); }
  /// True where that has changed whether this process speaks.
  bool settle(Clock::time_point now, std::int64_t wall_ns);
  /// Whether a monitor that shares the unit speaks for it.
  [[nodiscard]] bool stands_by() const { return role_ && !role_->active(); }
  /// Who spoke last for a unit that is shared, as idl::name_of; empty: nobody yet.
  [[nodiscard]] std::string speaker() const { return role_ ? role_->speaker() : ""; }

  /// Another one has said something: `name`, as idl::name_of; `writer`, as in idl::SampleInfo.
  void hear(std::uint64_t writer, std::string name, Clock::time_point now);
  /// All others have left.
  void hear_none() { others_.clear(); }
  /// What readers are to be told again, for they may have heard otherwise: all of it (true), for
  /// the other one has just left; what stands (false), while it speaks; nothing.
  [[nodiscard]] std::optional<bool> to_say_again(Clock::time_point now);

  [[nodiscard]] std::vector<bus::Trouble> troubles(const bus::Surroundings& around,
                                                   Clock::time_point now) const;
  /// True while `troubles` could use a fresh list of endpoints.
  [[nodiscard]] bool wants_endpoints() const { return role_ && role_->active(); }

 private:
  /// Who, and when it was heard.
  struct Other {
    std::string name;
    Clock::time_point heard;
  };

  [[nodiscard]] bool speaks(const Other& other, Clock::time_point now) const;
  [[nodiscard]] bool any_speaks(Clock::time_point now) const;
  [[nodiscard]] bool has_standby(const bus::Surroundings& around) const;
  [[nodiscard]] std::string names_text(const std::string& self, Clock::time_point now) const;

  std::string unit_;
  std::unique_ptr<Role> role_;
  Clock::time_point role_begins_;
  std::map<std::uint64_t, Other> others_;  // by writer
  bool spoke_ = false;                     // any of them, at the last look
};

}  // namespace mpm::live
