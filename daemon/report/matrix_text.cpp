#include "daemon/report/matrix_text.hpp"

#include <algorithm>
#include <set>

namespace mpm::report {
namespace {

constexpr std::size_t kIndent = 2, kGap = 2;
constexpr std::size_t kShortestTag = 8;  // even where there is no room

std::string line_of(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text + '\n';
}

// The last cell of a line needs no blanks behind it, painted or not.
std::string table(const std::vector<std::string>& columns, const std::vector<MatrixRow>& rows,
                  const std::vector<std::size_t>& widths, std::size_t tag_width, std::size_t first,
                  std::size_t end, const Layout& layout) {
  std::string text = std::string(kIndent, ' ') + padded("", tag_width);
  for (std::size_t i = first; i < end; ++i) {
    const std::string tag = shortened(columns[i], widths[i]);
    text += std::string(kGap, ' ') +
            layout.paint(Tint::kBold, i + 1 < end ? padded(tag, widths[i]) : tag);
  }
  text = line_of(text);
  for (const MatrixRow& row : rows) {
    std::size_t told = first;
    while (told < end && row.cells[told].text.empty()) ++told;
    if (row.tag.empty() && told == end) continue;
    std::string line =
        std::string(kIndent, ' ') + layout.paint(row.tag.empty() ? Tint::kPlain : Tint::kBold,
                                                 padded(shortened(row.tag, tag_width), tag_width));
    for (std::size_t i = first; i < end; ++i) {
      const MatrixCell& cell = row.cells[i];
      const std::string shown = shortened(cell.text, widths[i]);
      line += std::string(kGap, ' ') +
              layout.paint(cell.tint, i + 1 < end ? padded(shown, widths[i]) : shown);
    }
    text += line_of(line);
  }
  return text;
}

/// At least `width`, and so many columns that tags which differ still do when cut to it, as far as
/// `most` allows.
std::size_t telling_width(const std::vector<std::string>& tags, std::size_t width,
                          std::size_t most) {
  const std::set<std::string> different(tags.begin(), tags.end());
  const auto told_apart = [&different](std::size_t columns) {
    std::set<std::string> cut;
    for (const std::string& tag : different) cut.insert(shortened(tag, columns));
    return cut.size() == different.size();
  };
  while (width < most && !told_apart(width)) ++width;
  return width;
}

}  // namespace

std::string matrix_text(const std::vector<std::string>& columns, const std::vector<MatrixRow>& rows,
                        const Layout& layout) {
  const std::size_t room = std::max(layout.width, 2 * (kShortestTag + kGap)) - kIndent;
  const std::size_t most = room - kShortestTag - kGap;
  std::vector<std::string> row_tags;
  std::size_t tag_width = 0;
  for (const MatrixRow& row : rows) {
    row_tags.push_back(row.tag);
    tag_width = std::max(tag_width, columns_of(row.tag));
  }
  tag_width = std::min(tag_width, telling_width(row_tags, std::max(kShortestTag, room / 3), most));

  // A column may be as wide as a sixth of the line for its tag, and wider for what it says.
  const std::size_t widest = telling_width(columns, std::max(kShortestTag, room / 6), most);
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::size_t width = std::min(widest, columns_of(columns[i]));
    for (const MatrixRow& row : rows) width = std::max(width, columns_of(row.cells[i].text));
    widths.push_back(std::clamp(width, std::size_t{3}, room - tag_width - kGap));
  }

  std::string text;
  for (std::size_t first = 0, end = 0; first < columns.size(); first = end) {
    std::size_t used = tag_width;
    while (end < columns.size() && (end == first || used + kGap + widths[end] <= room))
      used += kGap + widths[end++];
    text += (first > 0 ? "\n" : "") + table(columns, rows, widths, tag_width, first, end, layout);
  }
  return text;
}

}  // namespace mpm::report
