#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/monitor/settings.hpp"
#include "sim/plant/channel_change.hpp"

/// Experiments as data: what is run, on which seeds, and which tables of the docs it fills.
///
/// Seeds from 1 on score the method and must not be looked at while it is being tuned; the short
/// version has its own from 90001 on. Whoever tunes takes seeds from 100001 on (`--seeds`).
namespace mpm::study {

struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t last = 100;

  [[nodiscard]] int count() const { return static_cast<int>(last - first + 1); }
};

/// A claim that the run must not contradict: the true rate of `metric` is at most (least) `rate`.
struct Bound {
  enum class Side { kAtMost, kAtLeast };
  std::string metric;  ///< see summary.hpp
  int at = 0;          ///< samples; 0 = the whole run
  Side side = Side::kAtMost;
  double rate = 0.0;
};

struct Experiment {
  std::string name;
  std::string unit = "shell3x3";  ///< file in config/plants
  std::string scenario = "none";  ///< file in config/scenarios, or `none`
  int samples = 3000;
  std::vector<int> also_at = {};  ///< earlier samples at which the verdicts are read too
  SeedRange seeds = {};
  /// Beside those of the scenario.
  std::vector<sim::ChannelChange> changes = {};
  /// Relative gain errors below this are neither healthy nor wrong: they may or may not be found.
  double material = 0.0;
  void (*settings)(MonitorSettings&) = nullptr;
  std::vector<Bound> bounds = {};
  std::string row = {}, column = {};  ///< in a table of kind kGrid
};

enum class TableKind { kHealthy, kVerdicts, kPower, kChange, kGrid, kRunLength, kTail };

struct Table {
  std::string name;  ///< of the markers in docs/validation.md
  TableKind kind;
  std::vector<std::string> experiments;  ///< patterns, in the order of the rows
};

struct Study {
  std::vector<Experiment> experiments;
  std::vector<Table> tables;
};

[[nodiscard]] Study full_study();
[[nodiscard]] Study short_study();

}  // namespace mpm::study
