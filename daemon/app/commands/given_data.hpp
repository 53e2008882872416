#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/files/times/time_choice.hpp"
#include "daemon/files/times/time_style.hpp"
#include "daemon/report/unit_performance.hpp"

namespace mpm::app {

/// What the files given to one option hold together.
struct Given {
  Recording recording;             ///< each file a run of it, or several
  std::vector<std::string> files;  ///< of each run
  std::string name;                ///< of all the files
};

/// Reads the files, of either kind, one after the other. What was left out or is missing goes to
/// `notices`, how well the unit is controlled in all that is taken to `performance` where that is
/// wanted. Throws config::InputError as the readers do.
[[nodiscard]] Given read_given(const std::vector<std::string>& files,
                               const config::UnitConfig& unit, const files::TimeStyle& times,
                               const files::TimeChoice& choice, std::vector<std::string>& notices,
                               report::PerformanceTally* performance = nullptr);

/// Leaves of a long recording what a diagnosis can bear, `every` rows averaged into one
/// (condensed()), and tells that in `notices`.
Condensing condense(Given& given, Eigen::Index every, std::vector<std::string>& notices);

/// The command line of this process as it was typed, quoted where a shell would need it.
[[nodiscard]] std::string command_line();

}  // namespace mpm::app
