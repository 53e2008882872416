#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identification/identification.hpp"
#include "core/identify/fit/recording.hpp"

namespace mpm::report {

/// All that is said of an identification is made from this.
struct IdentificationRun {
  config::UnitConfig unit;  ///< as its file says it
  Recording recording;
  Identification identification;
  std::string program;  ///< with its version
  std::string command_line;
  std::string config_file, data_file;
  std::string out_file;
  std::vector<std::string> notices;  ///< on the data
};

}  // namespace mpm::report
