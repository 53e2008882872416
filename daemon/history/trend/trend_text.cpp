#include "daemon/history/trend/trend_text.hpp"

#include <vector>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/history/trend/trend_words.hpp"
#include "daemon/report/matrix_text.hpp"

namespace mpm::history {
namespace {

using report::MatrixCell;
using report::MatrixRow;
using report::Tint;

const char* const kNothing = ".";

std::string head_text(const Trend& trend, const report::MomentText& moment) {
  return printable(trend.head.unit) + ": " +
         counted(static_cast<std::uint64_t>(trend.samples()), "sample") + " from " +
         moment.with_year(trend.periods.front().from_ns) + " to " +
         moment.with_year(trend.periods.back().until_ns) + moment.zone() + ", by " +
         std::string(to_string(trend.step));
}

// Periods without any sample have a row, too: they are no good ones.
template <class Cells>
std::vector<MatrixRow> rows_of(const Trend& trend, std::size_t columns, Cells cells) {
  std::vector<MatrixRow> rows;
  for (std::size_t k = 0; k < trend.periods.size(); ++k) {
    if (k > 0 && trend.periods[k].index > trend.periods[k - 1].index + 1)
      rows.push_back({"...", std::vector<MatrixCell>(columns, {kNothing, Tint::kGrey})});
    MatrixRow& row = rows.emplace_back();
    row.tag = period_name(trend, k);
    for (std::size_t c = 0; c < columns; ++c) row.cells.push_back(cells(trend.periods[k], c));
  }
  return rows;
}

MatrixCell error_cell(const CvPeriod& cv, const CvHead& head) {
  if (!known(cv.prediction_rms)) return {kNothing, Tint::kGrey};
  std::string text = number_text(cv.prediction_rms);
  if (!head.unit.empty()) text += ' ' + printable(head.unit);
  if (cv.movement_rms > 0.0) text += " (" + number_text(cv.fit(), 2) + " %)";
  return {text, Tint::kPlain};
}

/// Of a gain that the model does not have: " t/h per %"; empty where the units are not known.
std::string gain_unit(const Trend& trend, const ChannelHead& channel) {
  for (const CvHead& cv : trend.head.cvs)
    if (cv.cv == channel.cv && !cv.unit.empty() && !channel.mv_unit.empty())
      return ' ' + printable(cv.unit) + " per " + printable(channel.mv_unit);
  return {};
}

// The verdict that held for most of the time it was determined.
MatrixCell gain_cell(const ChannelPeriod& channel, const ChannelHead& head,
                     const std::string& gain_unit) {
  if (!known(channel.gain_error)) return {kNothing, Tint::kGrey};
  const bool wrong = channel.mismatch > channel.match;
  const std::string error = head.modelled ? (channel.gain_error > 0.0 ? "+" : "") +
                                                number_text(channel.gain_error, 2) + " %"
                                          : number_text(channel.gain_error) + gain_unit;
  return {error + (wrong ? " x" : ""), wrong ? Tint::kRed : Tint::kPlain};
}

void add_table(std::string& text, const std::string& title, const std::vector<std::string>& columns,
               const std::vector<MatrixRow>& rows, const report::Layout& layout) {
  std::string lines = report::wrapped(title, 0, layout.width);
  lines.pop_back();
  text +=
      '\n' + layout.paint(Tint::kBold, lines) + '\n' + report::matrix_text(columns, rows, layout);
}

void add_section(std::string& text, const char* title, const std::vector<std::string>& lines,
                 const report::Layout& layout) {
  if (lines.empty()) return;
  text += '\n' + layout.paint(Tint::kBold, title) + '\n';
  for (const std::string& line : lines) text += report::wrapped(line, 2, layout.width);
}

}  // namespace

std::string to_text(const Trend& trend, const Findings& findings, const report::Layout& layout,
                    const files::TimeZone* zone) {
  const report::MomentText moment(trend.periods.back().until_ns, trend.head.sample_time_s, zone);
  std::string text = report::wrapped(head_text(trend, moment), 0, layout.width);
  std::vector<std::string> cvs, channels;
  for (const CvHead& cv : trend.head.cvs) cvs.push_back(printable(cv.cv));
  for (const ChannelHead& channel : trend.head.channels)
    channels.push_back(printable(channel.mv) + ">" + printable(channel.cv));
  add_table(
      text,
      "Prediction errors " +
          number_text(static_cast<double>(trend.head.horizon_samples) * trend.head.sample_time_s) +
          " s ahead, RMS (and how much of the movement was predicted)",
      cvs,
      rows_of(trend, cvs.size(),
              [&](const Period& period, std::size_t c) {
                return error_cell(period.cvs[c], trend.head.cvs[c]);
              }),
      layout);
  add_table(text, "Gain errors, % of the model's (x mismatch, . not known)", channels,
            rows_of(trend, channels.size(),
                    [&](const Period& period, std::size_t c) {
                      const ChannelHead& channel = trend.head.channels[c];
                      return gain_cell(period.channels[c], channel, gain_unit(trend, channel));
                    }),
            layout);
  std::vector<std::string> changed, standing, silent;
  for (const Change& change : findings.changes) changed.push_back(words_of(trend, change, moment));
  for (const Standing& alarm : findings.standing)
    standing.push_back(words_of(trend, alarm, moment));
  for (const Silence& silence : findings.silent) silent.push_back(words_of(trend, silence));
  add_section(text, "Changed", changed, layout);
  add_section(text, "In alarm", standing, layout);
  add_section(text, "Cannot tell", silent, layout);
  return text + '\n' + report::wrapped(words_of_rate(trend, findings), 0, layout.width);
}

}  // namespace mpm::history
