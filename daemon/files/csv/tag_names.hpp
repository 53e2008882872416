#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Tags as historians decorate them in the names of columns.
namespace mpm::files {

/// What a column's name may stand for, nearest first: `\\SERVER\Plant/Q1.PV` stands for itself,
/// `Plant/Q1.PV`, `Plant/Q1`, `Q1.PV` and `Q1`. Left out are servers, providers and folders before
/// it, brackets around it, a unit or a word for the value behind it; never a word for something
/// else of that tag, such as a set-point or a mode.
[[nodiscard]] std::vector<std::string> plain_tags(std::string_view name);

/// The name without a unit or a word for the value behind it: `Q1.Value` is `Q1`.
[[nodiscard]] std::string_view without_value_word(std::string_view name);

/// Letters of ASCII in lower case, blanks of any width as plain ones.
[[nodiscard]] std::string folded(std::string_view name);

}  // namespace mpm::files
