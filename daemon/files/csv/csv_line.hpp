#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/finding.hpp"

/// Lines and cells of a text file with their places.
namespace mpm::files {

struct Cell {
  std::string_view text;  ///< trimmed, without quotes
  int column = 1;         ///< where it begins, from 1
};

/// Non-empty lines that are no `#` comment. Takes off the byte order mark and carriage returns.
/// From the first line on that is no UTF-8 all are taken as ISO 8859-1, and turned into UTF-8.
/// Blanks of any width are plain ones.
class LineReader {
 public:
  LineReader(std::unique_ptr<std::istream> input, std::string name);

  /// Moves to the next line; false at the end. Fails where it is longer than 4 MiB, and then goes
  /// on behind it.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::string& text() const { return line_; }
  /// From the next line on, one where a quote is open goes on in those behind it, the break between
  /// them a blank.
  void join_quoted() { joins_ = true; }
  /// Cuts the line into cells, which stay valid until `next`.
  void split(char delimiter, std::vector<Cell>& cells);
  /// Back to the first line.
  void rewind();
  /// Once, what is to be said of the text: that it was no UTF-8.
  [[nodiscard]] std::optional<std::string> take_notice();

  /// True if the line ended with a newline, as all but the last one of a cut-off file do.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] int number() const { return number_; }
  /// Up to here, newlines included.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[noreturn]] void fail(int column, const std::string& message) const;
  [[noreturn]] void fail(int line, int column, const std::string& message) const;

 private:
  std::unique_ptr<std::istream> input_;
  std::string name_;
  /// Everything up to the next newline; false at the end of the input.
  [[nodiscard]] bool read_line();
  void check_text();
  void close_quote();

  std::array<char, 4096> piece_{};  // as it comes from the input
  std::string line_;
  int number_ = 0;  // of the line's beginning
  int lines_read_ = 0;
  std::uint64_t bytes_read_ = 0;
  bool complete_ = true;
  bool too_long_ = false;  // the rest of the line is still to come
  bool joins_ = false;
  bool latin1_ = false;
  bool told_ = false;
};

/// A file to read lines from. Throws config::InputError where it cannot be read.
[[nodiscard]] std::unique_ptr<std::istream> open_file(const std::string& path);
/// Likewise, of what is read from its beginning more than once, as data files are: a pipe or a
/// device is refused.
[[nodiscard]] std::unique_ptr<std::istream> open_regular_file(const std::string& path);

/// Of `;`, tab and comma the one that the header uses most; where there is none `|`, else comma.
[[nodiscard]] char find_delimiter(std::string_view header);

}  // namespace mpm::files
