#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text as it stands on a terminal: columns, lines and colours.
namespace mpm::report {

/// What a text is to look like where colours are wanted. They only repeat what words say.
enum class Tint { kPlain, kBold, kGrey, kGreen, kRed };

/// How lines for people are laid out.
struct Layout {
  std::size_t width = 80;  ///< columns of a line, at most
  bool color = false;

  [[nodiscard]] std::string paint(Tint tint, const std::string& text) const;
};

/// Columns that a text takes: its characters.
[[nodiscard]] std::size_t columns_of(std::string_view text);
/// With blanks behind it up to `width` columns.
[[nodiscard]] std::string padded(std::string text, std::size_t width);
/// Of what is wider than `width` >= 3 columns the beginning and the end, with dots between: what
/// tells tags apart is more often there than in the middle.
[[nodiscard]] std::string shortened(const std::string& text, std::size_t width);
/// In lines no wider than `width` where its words allow, each ended: the first begins after
/// `indent` blanks, those after it two further. A number and its % stay together.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t indent, std::size_t width);
/// A whole text, each sentence of it `wrapped` behind its own indent; rows of a table, which have
/// two blanks in a row, stay as they are.
[[nodiscard]] std::string sentences_wrapped(const std::string& text, std::size_t width);

}  // namespace mpm::report
