#pragma once

#include <string>
#include <vector>

#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::report {

struct MatrixCell {
  std::string text;
  Tint tint = Tint::kPlain;
};

struct MatrixRow {
  std::string tag;                ///< empty: the row goes on with the one above
  std::vector<MatrixCell> cells;  ///< one per column
};

/// A table with tags over its columns and before its rows, two blanks from the left. No line is
/// wider than the layout: long tags are cut in the middle, and columns that find no room follow in
/// a table of their own, after an empty line.
[[nodiscard]] std::string matrix_text(const std::vector<std::string>& columns,
                                      const std::vector<MatrixRow>& rows, const Layout& layout);

}  // namespace mpm::report
