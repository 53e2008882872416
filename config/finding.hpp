#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mpm::config {

enum class Severity { kError, kWarning };

/// One thing that is wrong with a file, at a place in it. Lines and columns count from 1; 0 where
/// there is no place to name.
struct Finding {
  std::string file;
  int line = 0;
  int column = 0;
  Severity severity = Severity::kError;
  std::string key;      ///< where in the document, e.g. `model.channels[2].gain`; may be empty
  std::string message;  ///< without file, place, severity and key
};

/// `file:line:col: error: key: message`, in one line: what the file holds is no part of a
/// terminal's commands, and what is very long ends in dots.
[[nodiscard]] std::string format(const Finding& finding);

[[nodiscard]] bool has_errors(const std::vector<Finding>& findings);

/// Bad input found while reading; what() is the formatted finding.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Finding finding)
      : std::runtime_error(format(finding)), finding_(std::move(finding)) {}
  [[nodiscard]] const Finding& finding() const { return finding_; }

 private:
  Finding finding_;
};

}  // namespace mpm::config
