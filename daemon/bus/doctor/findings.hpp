#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/bus/trouble.hpp"
#include "idl/discovery.hpp"

namespace mpm::bus {

/// One writer of an input, as a unit sees it.
struct WriterFindings {
  idl::Process process;
  std::vector<std::string> mismatch;  ///< as idl::Endpoint
  std::uint64_t samples = 0;          ///< of the unit
  double rate_hz = 0.0;               ///< 0: too few samples
  double age_s = 0.0;                 ///< since the last sample
  double clock_offset_s = 0.0;        ///< arrival on this machine minus source time, mean
  std::uint64_t skipped = 0;          ///< interval numbers left out
  std::uint64_t repeated = 0;         ///< samples of the interval before
};

struct TopicFindings {
  std::string topic;
  bool needed = false;
  std::vector<WriterFindings> writers;
};

/// Somebody who speaks as the unit's monitor.
struct MonitorFindings {
  idl::Process process;
  std::string state, detail;  ///< of mpm/health
  std::uint32_t active_alarms = 0;
  double age_s = 0.0;                 ///< since the last word
  std::uint32_t silenced_alarms = 0;  ///< of the active ones
};

struct UnitFindings {
  std::string unit;
  std::string place;  ///< as in Findings, where those are of several; else empty
  std::vector<MonitorFindings> monitors;
  std::vector<idl::Process> standbys;  ///< would speak should none of these do
  std::vector<TopicFindings> topics;
  std::vector<Trouble> troubles;  ///< the worst first
};

/// What `mpm doctor` has to say.
struct Findings {
  std::string place;  ///< as in Surroundings
  std::vector<UnitFindings> units;
  std::vector<Trouble> troubles;   ///< of no unit in particular
  std::vector<std::string> notes;  ///< worth knowing, no trouble

  [[nodiscard]] bool all_well() const;
};

/// What was found on several places as one; each unit and what is of no unit tell theirs.
[[nodiscard]] Findings joined(std::vector<Findings> of_places);

/// What to do about a trouble, as a sentence.
[[nodiscard]] std::string advice(const Trouble& trouble);

/// A table per unit, then one line per trouble with advice, the most important first.
[[nodiscard]] std::string to_text(const Findings& findings);
[[nodiscard]] nlohmann::ordered_json to_json(const Findings& findings);

}  // namespace mpm::bus
