#pragma once

#include <string>

namespace mpm::test {

/// The part of a journal that is kept: for each channel a line whenever its verdict or the reason
/// changes and every few hundred samples, every alarm, and a hash of the whole journal, so that no
/// change of a single digit passes.
[[nodiscard]] std::string condensed(const std::string& journal);

/// A table of what differs between two condensed journals, per channel: last verdict, its numbers,
/// how often it changed, when alarms came and went. Not empty where the texts differ.
[[nodiscard]] std::string difference(const std::string& before, const std::string& after);

}  // namespace mpm::test
