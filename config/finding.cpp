#include "config/finding.hpp"

#include <algorithm>

#include "core/text/printable.hpp"

namespace mpm::config {
namespace {

constexpr std::size_t kLongestPath = 4096, kLongestMessage = 2000;

}  // namespace

std::string format(const Finding& finding) {
  std::string text = printable(finding.file, kLongestPath);
  if (finding.line > 0) {
    text += ':' + std::to_string(finding.line);
    text += ':' + std::to_string(std::max(finding.column, 1));
  }
  if (!text.empty()) text += ": ";
  text += finding.severity == Severity::kError ? "error: " : "warning: ";
  if (!finding.key.empty()) text += printable(finding.key) + ": ";
  return text + printable(finding.message, kLongestMessage);
}

bool has_errors(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

}  // namespace mpm::config
