#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/files/times/time_style.hpp"

namespace mpm::files {

/// A stretch of time of which the end is not part, ns on the clock of the data.
struct Stretch {
  std::int64_t from_ns = 0;
  std::int64_t until_ns = 0;
};

/// As somebody typed it: seconds or ISO 8601, and `A/B` for a stretch; empty = not given.
struct TimeChoiceText {
  std::string from, until;
  std::vector<std::string> exclude;
};

/// Which rows of a data file are to be used.
class TimeChoice {
 public:
  /// All of them.
  TimeChoice() = default;
  /// Times are written in the usual ways or as in the file; local ones are refused without a zone
  /// in `times`. Throws config::InputError, naming the option, where a text is no time or a stretch
  /// ends before it begins.
  explicit TimeChoice(const TimeChoiceText& text, const TimeStyle& times = {});

  /// Whether all rows are to be used.
  [[nodiscard]] bool all() const { return !from_ns_ && !until_ns_ && excluded_.empty(); }
  [[nodiscard]] bool takes(std::int64_t time_ns) const;

 private:
  std::optional<std::int64_t> from_ns_, until_ns_;  ///< the first that is taken, and is no more
  std::vector<Stretch> excluded_;
};

/// What of a file was used: stretches between which rows were left out. Here their ends are rows.
class UsedStretches {
 public:
  /// Rows in their order, whether taken or not.
  void note(std::int64_t time_ns, bool taken);
  [[nodiscard]] const std::vector<Stretch>& stretches() const { return stretches_; }

 private:
  std::vector<Stretch> stretches_;
  bool open_ = false;
};

/// One line for a person: that nothing is left, and what time the rows have that there are.
[[nodiscard]] std::string nothing_chosen(std::int64_t first_ns, std::int64_t last_ns);

}  // namespace mpm::files
