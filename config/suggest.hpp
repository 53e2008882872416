#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mpm::config {

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`, without
/// regard to case (optimal string alignment distance).
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// The one of `known` that `word` is most likely a slip of; null where none is close.
[[nodiscard]] const std::string* closest(std::string_view word,
                                         const std::vector<std::string>& known);

/// ` (did you mean 'x'?)` for the closest of `known` if one is close enough to `word`, else the
/// list of them if it is short (` (known: a, b)`), else empty.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& known);

/// `a, b, c`; at most `limit` of them and then `... (12 more)`.
[[nodiscard]] std::string join(const std::vector<std::string>& words, std::size_t limit = 12);

}  // namespace mpm::config
