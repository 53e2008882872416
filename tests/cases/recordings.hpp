#pragma once

#include <string>

#include "tests/system/process.hpp"

namespace mpm::test {

/// The measured plants' recordings (docs/cases.md), cut to the cases' needs, where they are at
/// hand: in the folder that MPM_DATA_DIR names, else beside the sources. They are read in place.
class Recordings {
 public:
  Recordings();

  /// File of the cut recording; empty where it is not at hand.
  [[nodiscard]] std::string find(const std::string& name) const;

  /// What a test is to say, loudly, of a recording that was not found.
  [[nodiscard]] std::string skipped(const std::string& name) const;

 private:
  TemporaryFolder cut_;
  std::string problem_;
};

}  // namespace mpm::test
