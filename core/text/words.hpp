#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace mpm {

/// An enumeration with words for people and files: beside it stands
///   constexpr auto words_of(E) { return std::array{"first", "second" ...}; }
/// with the word of each enumerator, in the order of their values 0, 1, ...
template <class E>
concept Worded = requires(E e) {
  words_of(e);
};

/// Ends with a null character. Empty for a value that has no word.
template <Worded E>
[[nodiscard]] constexpr std::string_view to_string(E value) {
  constexpr auto kWords = words_of(E{});
  const auto index = static_cast<std::size_t>(value);
  return index < kWords.size() ? kWords[index] : "";
}

/// None where no enumerator has this word.
template <Worded E>
[[nodiscard]] constexpr std::optional<E> from_string(std::string_view word) {
  constexpr auto kWords = words_of(E{});
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (word == kWords[i]) return static_cast<E>(i);
  return std::nullopt;
}

}  // namespace mpm
