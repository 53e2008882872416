#pragma once

#include <string>

namespace mpm::test {

/// report.json laid out to be read in a diff.
[[nodiscard]] std::string laid_out(const std::string& report);

/// The data that report.html draws: of each series its length, its ends and a hash of all its
/// numbers, so that no digit moves unseen. Throws std::runtime_error where the page holds no data.
[[nodiscard]] std::string condensed_page(const std::string& page);

/// What moved from one JSON text to another: the paths of the first few values, before and after.
/// Not empty where the texts differ.
[[nodiscard]] std::string json_difference(const std::string& before, const std::string& after);

/// The same of any text, by line.
[[nodiscard]] std::string line_difference(const std::string& before, const std::string& after);

}  // namespace mpm::test
