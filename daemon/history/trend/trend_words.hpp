#pragma once

#include <string>

#include "daemon/history/trend/changes.hpp"
#include "daemon/report/moment_text.hpp"

/// What is said of a trend in words, the same in the terminal, the JSON and the picture.
namespace mpm::history {

/// "FIC-101 -> AI-201: gain +41 % (31 to 51) since 14:20 on 3 March; was within 5 % before", or
/// "AI-201: prediction errors 2.1 times as large (1.8 to 2.5) since week 12 (from 16 March)".
[[nodiscard]] std::string words_of(const Trend& trend, const Change& change,
                                   const report::MomentText& moment);
[[nodiscard]] std::string words_of(const Trend& trend, const Standing& standing,
                                   const report::MomentText& moment);
[[nodiscard]] std::string words_of(const Trend& trend, const Silence& silence);

/// "u1 -> y1" of two tags, fit for a line.
[[nodiscard]] std::string channel_name(const std::string& mv, const std::string& cv);

/// What a reader is to know of the statements: their error rate, or why there is none.
[[nodiscard]] std::string words_of_rate(const Trend& trend, const Findings& findings);

}  // namespace mpm::history
