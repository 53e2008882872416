#include "daemon/report/performance_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"

namespace mpm::report {
namespace {

constexpr std::size_t kLongestTag = 20;
constexpr std::size_t kBetween = 2;  // blanks

using Row = std::vector<std::string>;

std::string number(double value, int digits = 3) {
  return std::isfinite(value) ? number_text(value, digits) : "--";
}
std::string share(double value) { return std::isfinite(value) ? percent_text(value) : "--"; }
std::string tag(const std::string& text) { return shortened(printable(text), kLongestTag); }

/// Tags to the left, numbers to the right; the first row is the head.
std::string table(const std::vector<Row>& rows, const Layout& layout) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      widths[c] = std::max(widths[c], columns_of(row[c]));
  std::string text;
  for (const Row& row : rows) {
    std::string line(kBetween, ' ');
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string blanks(widths[c] - columns_of(row[c]), ' ');
      if (c > 0) line += std::string(kBetween, ' ');
      line += c == 0 ? row[c] + blanks : blanks + row[c];
    }
    text += (&row == &rows.front() ? layout.paint(Tint::kBold, line) : line) + '\n';
  }
  return text;
}

}  // namespace

std::string performance_text(const PerformanceRecord& record, const Layout& layout) {
  std::string text = layout.paint(Tint::kBold, "Control performance") + "\n  " +
                     counted(static_cast<std::uint64_t>(record.samples), "sample") +
                     "; the controller acts in " + share(record.service_factor) + " of them\n\n";
  std::vector<Row> controlled = {{"CV", "mean error", "s.d.", "outside"}};
  std::vector<Row> predicted = {{"CV"}};
  if (!record.cvs.empty())
    for (const HorizonError& horizon : record.cvs.front().prediction)
      predicted.front().push_back(std::to_string(horizon.samples) + " ahead");
  for (const CvPerformance& cv : record.cvs) {
    controlled.push_back({tag(cv.cv), number(cv.control_error.mean),
                          number(std::sqrt(cv.control_error.variance)), share(cv.outside_limits)});
    predicted.push_back({tag(cv.cv)});
    for (const HorizonError& horizon : cv.prediction)
      predicted.back().push_back(number(horizon.rmse, 2) + " / " + number(horizon.movement_rms, 2));
  }
  text += table(controlled, layout) + '\n' + table(predicted, layout) +
          wrapped("RMS error of predictions so many samples ahead / what the CV itself moved", 2,
                  layout.width) +
          '\n';
  std::vector<Row> mvs = {{"MV", "at low", "at high", "travel", "standing"}};
  for (const MvPerformance& mv : record.mvs)
    mvs.push_back(
        {tag(mv.mv), share(mv.at_low), share(mv.at_high), number(mv.travel), share(mv.standing)});
  return text + table(mvs, layout) +
         wrapped("travel: mean absolute move per sample", 2, layout.width);
}

}  // namespace mpm::report
