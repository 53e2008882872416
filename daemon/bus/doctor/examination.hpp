#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "daemon/bus/doctor/findings.hpp"
#include "daemon/bus/survey.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/bus/window_statistics.hpp"
#include "idl/cdr.hpp"

namespace mpm::bus {

/// Listens to a domain for a while, then says how each unit fares on it.
class Examination {
 public:
  using Clock = std::chrono::steady_clock;

  /// `units`: what should be there; empty: whatever is. `place`: as in Surroundings.
  Examination(const idl::Participant& participant, std::string place,
              const std::vector<ExpectedInputs>& units, Clock::duration silence);

  /// Waits for samples, at most `longest`.
  void listen(std::chrono::milliseconds longest);
  [[nodiscard]] Findings findings() const;

 private:
  /// The samples of one unit that one writer wrote to one topic.
  struct Stream {
    WindowStatistics periods_s{kWindow}, offsets_s{kWindow};
    Clock::time_point last{};
  };
  struct Word {  // a monitor's last one
    std::string state, detail;
    std::uint32_t active_alarms = 0, silenced_alarms = 0;
    Clock::time_point when;
  };
  struct Unit {
    UnitInputs inputs;
    bool described = false;  // by its unit file or a layout
    std::map<std::pair<SignalKind, std::uint64_t>, Stream> streams;
    std::map<std::uint64_t, Word> monitors;  // by writer
  };
  static constexpr std::size_t kWindow = 10000;

  Unit* unit_of(const char* name, std::uint64_t writer);
  void hear(const std::string& topic, const idl::RawSample& sample);
  void hear(SignalKind kind, const mpm_Sample& sample, std::uint64_t writer);
  void hear(const mpm_Layout& layout, std::uint64_t writer);
  [[nodiscard]] UnitFindings findings_of(const Unit& unit, const Surroundings& around,
                                         Clock::time_point now) const;
  [[nodiscard]] TopicFindings topic_of(const Unit& unit, SignalKind kind,
                                       const Surroundings& around, Clock::time_point now) const;

  Survey survey_;
  std::string place_;
  Clock::time_point start_;
  Clock::duration silence_;
  bool open_;  // to units that nobody named
  std::map<std::string, Unit> units_;
  std::map<std::string, std::uint64_t> strangers_;  // as in Surroundings
  idl::CdrDecoder<mpm_Sample> samples_;
  idl::CdrDecoder<mpm_Layout> layouts_;
  idl::CdrDecoder<mpm_Health> health_;
};

}  // namespace mpm::bus
