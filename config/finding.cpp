#include "config/finding.hpp"

#include <algorithm>

namespace mpm::config {

std::string format(const Finding& finding) {
  std::string text = finding.file;
  if (finding.line > 0) {
    text += ':' + std::to_string(finding.line);
    text += ':' + std::to_string(std::max(finding.column, 1));
  }
  if (!text.empty()) text += ": ";
  text += finding.severity == Severity::kError ? "error: " : "warning: ";
  if (!finding.key.empty()) text += finding.key + ": ";
  return text + finding.message;
}

bool has_errors(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

}  // namespace mpm::config
