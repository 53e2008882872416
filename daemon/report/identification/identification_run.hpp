#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identification/identification.hpp"
#include "core/identification/test_plan.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/files/times/time_zone.hpp"

namespace mpm::report {

/// All that is said of an identification is made from this.
struct IdentificationRun {
  config::UnitConfig unit;  ///< as its file says it
  Recording recording;
  Identification identification;
  std::string program;  ///< with its version
  std::string command_line;
  std::string config_file, data_file;
  std::string out_file;                              ///< empty where none is to be written
  std::optional<std::vector<PlannedTest>> plan;      ///< where one was asked for
  std::vector<std::string> notices;                  ///< on the data
  std::shared_ptr<const files::TimeZone> zone = {};  ///< of the data's times; null = UTC
  Condensing condensing = {};                        ///< of the data files' recording
};

}  // namespace mpm::report
