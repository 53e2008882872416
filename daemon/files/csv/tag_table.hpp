#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"
#include "daemon/files/purpose.hpp"

namespace mpm::files {

/// Where a tag's values go in a frame.
struct Slot {
  SignalKind kind = SignalKind::kMv;
  int index = 0;
};

/// The measured tags of a unit and which of them a file holds. A name that is no tag is read as one
/// where it can only be that tag, decorated (`tag_names`): no name in the file is that tag, and no
/// other one could be it.
class TagTable {
 public:
  explicit TagTable(const config::UnitConfig& unit, Purpose purpose = Purpose::kJudge);

  /// Where what the file calls `name` goes; of what has been seen. Null for what the unit does not
  /// name, or calculates.
  [[nodiscard]] const Slot* find(std::string_view name) const;
  /// The unit's tag that the file calls `name`; null where it is none.
  [[nodiscard]] const std::string* tag_of(std::string_view name) const;
  /// Notes that the file holds `name`, known or not.
  void see(std::string_view name);
  /// True where the file holds the unit's tag.
  [[nodiscard]] bool seen(const std::string& tag) const;

  /// What is wrong with the set of names seen; empty where it will do. No tag may have two names.
  /// To judge the unit takes all inputs and CVs, and predictions if it has no model, or what those
  /// are calculated from.
  [[nodiscard]] std::string problem() const;
  /// Which names are read as which tags; empty where none is.
  [[nodiscard]] std::string readings() const;
  /// What the user should know: names read as tags, names ignored, predictions that will be
  /// simulated, absent signals.
  [[nodiscard]] std::vector<std::string> notices() const;

 private:
  [[nodiscard]] std::vector<std::string> absent() const;
  /// The unit's tag for which a name may stand that is none itself; empty where there is none.
  [[nodiscard]] std::string likely_tag(std::string_view name) const;
  /// Names that could be `tag`, where no name is; null where there are none.
  [[nodiscard]] const std::vector<std::string>* readings_of(const std::string& tag) const;
  [[nodiscard]] std::string two_names_problem() const;
  /// In the order of the file: what neither is a tag nor is read as one.
  [[nodiscard]] std::vector<std::string> ignored() const;

  config::UnitConfig unit_;
  Purpose purpose_;
  std::unordered_map<std::string, Slot> slots_;
  std::unordered_map<std::string, bool> seen_;
  std::unordered_map<std::string, std::string> folded_;       ///< to the tag; empty = there are two
  std::unordered_map<std::string, std::string> read_as_;      ///< from names to tags
  std::map<std::string, std::vector<std::string>> readings_;  ///< the other way
  std::vector<std::string> others_;        ///< names that are no tags, in the order of the file
  std::vector<std::string> recalculated_;  ///< likewise
};

}  // namespace mpm::files
