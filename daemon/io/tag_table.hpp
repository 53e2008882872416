#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::io {

/// Where a tag's values go in a frame.
struct Slot {
  SignalKind kind = SignalKind::kMv;
  int index = 0;
};

/// The tags of a unit and which of them a file holds.
class TagTable {
 public:
  explicit TagTable(const config::UnitConfig& unit);

  /// Null for a tag that the unit does not name.
  [[nodiscard]] const Slot* find(std::string_view tag) const;
  /// Notes that the file holds `tag`, known or not.
  void see(std::string_view tag);
  [[nodiscard]] bool seen(const std::string& tag) const;

  /// What is wrong with the set of tags seen; empty where it will do. Missing predictions are fine
  /// if the unit has a model.
  [[nodiscard]] std::string problem() const;
  /// What the user should know: tags ignored, predictions that the file does not hold and what
  /// becomes of them.
  [[nodiscard]] std::vector<std::string> notices(
      const std::string& without_prediction = "so the unit file's model simulates instead") const;
  [[nodiscard]] std::vector<bool> has_prediction() const;

 private:
  config::UnitConfig unit_;
  std::unordered_map<std::string, Slot> slots_;
  std::unordered_map<std::string, bool> seen_;
  std::vector<std::string> ignored_;  ///< in the order of the file
};

}  // namespace mpm::io
