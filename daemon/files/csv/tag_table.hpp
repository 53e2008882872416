#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::files {

/// Where a tag's values go in a frame.
struct Slot {
  SignalKind kind = SignalKind::kMv;
  int index = 0;
};

/// What a file is read for: to judge the unit, or to keep whatever of it is there.
enum class Purpose { kJudge, kKeep };

/// The measured tags of a unit and which of them a file holds.
class TagTable {
 public:
  explicit TagTable(const config::UnitConfig& unit, Purpose purpose = Purpose::kJudge);

  /// Null for a tag that the unit does not name, or calculates.
  [[nodiscard]] const Slot* find(std::string_view tag) const;
  /// Notes that the file holds `tag`, known or not.
  void see(std::string_view tag);
  [[nodiscard]] bool seen(const std::string& tag) const;

  /// What is wrong with the set of tags seen; empty where it will do. To judge the unit takes all
  /// inputs and CVs, and predictions if it has no model, or what those are calculated from.
  [[nodiscard]] std::string problem() const;
  /// What the user should know: tags ignored, predictions that will be simulated, absent signals.
  [[nodiscard]] std::vector<std::string> notices() const;

 private:
  [[nodiscard]] std::vector<std::string> absent() const;

  config::UnitConfig unit_;
  Purpose purpose_;
  std::unordered_map<std::string, Slot> slots_;
  std::unordered_map<std::string, bool> seen_;
  std::vector<std::string> ignored_;       ///< in the order of the file
  std::vector<std::string> recalculated_;  ///< likewise
};

}  // namespace mpm::files
