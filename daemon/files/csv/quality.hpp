#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/signal/frame.hpp"

/// What the quality columns of data files say; all words and codes stand in quality.cpp.
namespace mpm::files {

/// How a quality column speaks, told by its name.
enum class QualityKind {
  kCode,        ///< words, or codes as of OPC
  kGoodFlag,    ///< true or 1 = good, anything else bad
  kDoubtFlag,   ///< true or 1 = uncertain, false or 0 = good
  kConfidence,  ///< percent: 100 good, from 50 on uncertain, less bad
};

/// What a column of that name says, without case, blanks and signs; nothing for other names.
[[nodiscard]] std::optional<QualityKind> quality_kind(std::string_view name);

/// Of several quality columns in one table the one to ask first, 0 before 1.
[[nodiscard]] int quality_rank(std::string_view name);

/// What a cell says: empty = good. With `zero_is_good` the numbers are those of AVEVA Historian's
/// Quality (0 good, 1 bad, 16 doubtful, 133 first value of a query), else OPC DA (192, 64, 0 with
/// substatus), OPC HDA, OPC UA or Ignition codes. Nothing for any other text.
[[nodiscard]] std::optional<Quality> parse_quality(std::string_view text,
                                                   QualityKind kind = QualityKind::kCode,
                                                   bool zero_is_good = false);

/// The cell as a code; nothing for words.
[[nodiscard]] std::optional<std::int64_t> quality_code(std::string_view text);
/// True for a code that there is where zero is good.
[[nodiscard]] bool fits_zero_is_good(std::int64_t code);

}  // namespace mpm::files
