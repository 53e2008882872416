#pragma once

#include <string>

#include "config/unit_config.hpp"

namespace mpm::files {

/// A discrete state space from a folder of tables A.csv, B.csv, C.csv and, where they are there,
/// D.csv and x0.csv: a row of the matrix per line, numbers alone. Comma, semicolon or tab between
/// the cells; with the latter two a comma is a decimal comma. B.csv and D.csv may begin with a line
/// of tags, which must be the unit's MVs and DVs in its order, and rows of C.csv and D.csv with a
/// CV's. A first line `# sample_time: 10` (s) of A.csv must be the unit's. Throws
/// config::InputError with the place of what is no number, of a row of another length, of a tag
/// that stands elsewhere in the unit file, or with the file whose matrix has the wrong shape.
[[nodiscard]] StateSpaceSpec read_state_space_folder(const std::string& folder,
                                                     const config::UnitConfig& unit);

}  // namespace mpm::files
