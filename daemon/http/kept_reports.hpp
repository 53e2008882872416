#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mpm::http {

/// Reads what the daemon's diagnoses have left (live::ReportStore), and nothing beside it.
class KeptReports {
 public:
  /// Larger files are none of ours.
  static constexpr std::size_t kMostBytes = 32'000'000;

  /// `folder` empty: there are none.
  explicit KeptReports(std::string folder) : folder_(std::move(folder)) {}

  /// Names of a unit's reports, those of the youngest alarms first.
  [[nodiscard]] std::vector<std::string> names(const std::string& unit) const;
  /// One of report.html and report.json; nothing where there is none of that name.
  [[nodiscard]] std::optional<std::string> read(const std::string& unit, const std::string& name,
                                                const std::string& file) const;

 private:
  std::string folder_;
};

}  // namespace mpm::http
