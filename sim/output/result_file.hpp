#pragma once

#include <fstream>
#include <optional>
#include <ostream>
#include <string>

#include "config/replacement_file.hpp"

namespace mpm::sim {

/// Where a run writes to: a file that appears when it is whole, standard output (`-`), or a device
/// or pipe, which is written to as it is there.
class ResultFile {
 public:
  /// Throws config::InputError for a link to a file and where the file cannot be made,
  /// std::runtime_error where a device cannot be opened.
  explicit ResultFile(const std::string& path);

  [[nodiscard]] std::ostream& stream() { return *out_; }
  /// Throws std::runtime_error where not everything could be written.
  void commit();

 private:
  std::string path_;
  std::optional<config::ReplacementFile> file_;
  std::ofstream device_;
  std::ostream* out_ = nullptr;
};

}  // namespace mpm::sim
