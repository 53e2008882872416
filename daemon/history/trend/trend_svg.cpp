#include "daemon/history/trend/trend_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/history/trend/trend_words.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::history {
namespace {

constexpr double kMargin = 16.0, kLabels = 110.0, kTop = 78.0;
constexpr std::size_t kLongestLabel = 40;  // characters
constexpr double kCharacter = 8.0;         // of a label, at most, nearly always
constexpr double kPanelWidth = 250.0, kPanelHeight = 84.0, kGap = 34.0, kRowGap = 26.0;
constexpr double kStrip = 5.0;  // of the verdicts, under a panel
constexpr double kLine = 17.0;  // of text
constexpr double kMostPercent = 150.0;
constexpr std::size_t kWordsWidth = 100;  // columns
const char* const kInk = "#222222";
const char* const kGrey = "#888888";
const char* const kFaint = "#dddddd";
const char* const kBlue = "#1f5fa8";
const char* const kPale = "#b9cfe8";
const char* const kOrange = "#d9641e";
const char* const kTint = "#f4f1e8";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else if (letter == '&')
      safe += "&amp;";
    else if (letter == '"')
      safe += "&quot;";
    else
      safe += letter;
  }
  return safe;
}

std::string at(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

class Picture {
 public:
  void rect(double x, double y, double width, double height, const char* fill) {
    parts_ += R"(<rect x=")" + at(x) + R"(" y=")" + at(y) + R"(" width=")" + at(width) +
              R"(" height=")" + at(height) + R"(" fill=")" + fill + "\"/>\n";
  }
  void line(double x1, double y1, double x2, double y2, const char* colour, double width = 1.0,
            const char* dashes = nullptr) {
    parts_ += R"(<line x1=")" + at(x1) + R"(" y1=")" + at(y1) + R"(" x2=")" + at(x2) + R"(" y2=")" +
              at(y2) + R"(" stroke=")" + colour + R"(" stroke-width=")" + at(width) + "\"" +
              (dashes == nullptr ? "" : " stroke-dasharray=\"" + std::string(dashes) + "\"") +
              "/>\n";
  }
  void dot(double x, double y, const char* colour) {
    parts_ +=
        R"(<circle cx=")" + at(x) + R"(" cy=")" + at(y) + R"(" r="2.2" fill=")" + colour + "\"/>\n";
  }
  void text(double x, double y, const std::string& text, const char* colour = kInk, int size = 12,
            const char* anchor = "start", bool bold = false) {
    parts_ += R"(<text x=")" + at(x) + R"(" y=")" + at(y) + R"(" font-size=")" +
              std::to_string(size) + R"(" fill=")" + colour + R"(" text-anchor=")" + anchor + "\"" +
              (bold ? " font-weight=\"bold\"" : "") + ">" + escaped(text) + "</text>\n";
  }
  [[nodiscard]] std::string svg(double width, double height, const std::string& title) const {
    const std::string size = at(width) + " " + at(height);
    return R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" + size + R"(" width=")" +
           at(width) + R"(" height=")" + at(height) +
           R"(" font-family="Helvetica, Arial, sans-serif" role="img">)" + "\n<title>" +
           escaped(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
           parts_ + "</svg>\n";
  }

 private:
  std::string parts_;
};

/// The panels of one trend.
class Panels {
 public:
  Panels(const Trend& trend, const Findings& findings, Picture& picture)
      : trend_(trend), findings_(findings), picture_(picture) {
    const std::int64_t first = trend.periods.front().index;
    periods_ = static_cast<double>(trend.periods.back().index - first + 1);
  }

  void errors(double x, double y, std::size_t cv) {
    double top = 0.0;
    for (const Period& period : trend_.periods)
      if (known(period.cvs[cv].prediction_rms)) top = std::max(top, period.cvs[cv].prediction_rms);
    frame(x, y);
    if (top == 0.0) return nothing(x, y);
    top *= 1.1;
    picture_.text(x - 4.0, y + 9.0, number_text(top, 2), kGrey, 10, "end");
    picture_.text(x - 4.0, y + kPanelHeight, "0", kGrey, 10, "end");
    double before_x = 0.0, before_y = 0.0;
    for (std::size_t k = 0; k < trend_.periods.size(); ++k) {
      const double error = trend_.periods[k].cvs[cv].prediction_rms;
      if (!known(error)) continue;
      const double px = middle(x, k), py = y + kPanelHeight * (1.0 - error / top);
      const bool joined = k > 0 && known(trend_.periods[k - 1].cvs[cv].prediction_rms) &&
                          trend_.periods[k - 1].index + 1 == trend_.periods[k].index;
      if (joined) picture_.line(before_x, before_y, px, py, kBlue, 1.4);
      picture_.dot(px, py, kBlue);
      before_x = px;
      before_y = py;
    }
    mark(x, y, "", trend_.head.cvs[cv].cv);
  }

  void gain(double x, double y, std::size_t channel) {
    const ChannelHead& head = trend_.head.channels[channel];
    double reach = head.modelled ? 400.0 * head.gain_limit : 0.0;
    for (const Period& period : trend_.periods) {
      const ChannelPeriod& of = period.channels[channel];
      if (known(of.gain_error)) reach = std::max({reach, std::abs(of.low), std::abs(of.high)});
    }
    if (head.modelled) reach = std::min(reach, kMostPercent);
    frame(x, y);
    verdicts(x, y, channel);
    const bool any = std::any_of(trend_.periods.begin(), trend_.periods.end(), [&](const auto& p) {
      return known(p.channels[channel].gain_error);
    });
    if (!any || reach == 0.0) return nothing(x, y);
    const auto height = [&](double error) {
      return y + kPanelHeight * 0.5 * (1.0 - std::clamp(error / reach, -1.0, 1.0));
    };
    if (head.modelled) {
      const double limit = 100.0 * head.gain_limit;
      picture_.rect(x, height(limit), kPanelWidth, height(-limit) - height(limit), kTint);
    }
    picture_.line(x, height(0.0), x + kPanelWidth, height(0.0), kGrey, 0.8);
    const std::string unit = head.modelled ? " %" : "";
    picture_.text(x - 4.0, y + 9.0, "+" + number_text(reach, 2) + unit, kGrey, 10, "end");
    picture_.text(x - 4.0, y + kPanelHeight, "-" + number_text(reach, 2) + unit, kGrey, 10, "end");
    for (std::size_t k = 0; k < trend_.periods.size(); ++k) {
      const ChannelPeriod& of = trend_.periods[k].channels[channel];
      if (!known(of.gain_error)) continue;
      const double width = std::clamp(0.6 * kPanelWidth / periods_, 1.0, 6.0);
      picture_.line(middle(x, k), height(of.low), middle(x, k), height(of.high), kPale, width);
      picture_.dot(middle(x, k), height(of.gain_error), of.mismatch > of.match ? kOrange : kBlue);
    }
    mark(x, y, head.mv, head.cv);
  }

  /// Under the lowest panels.
  void axis(double x, double y) {
    picture_.text(x, y, period_name(trend_, 0), kGrey, 10);
    if (trend_.periods.size() > 1)
      picture_.text(x + kPanelWidth, y, period_name(trend_, trend_.periods.size() - 1), kGrey, 10,
                    "end");
  }

 private:
  [[nodiscard]] double left(double x, std::size_t period) const {
    const auto index =
        static_cast<double>(trend_.periods[period].index - trend_.periods.front().index);
    return x + kPanelWidth * index / periods_;
  }
  [[nodiscard]] double middle(double x, std::size_t period) const {
    return left(x, period) + 0.5 * kPanelWidth / periods_;
  }

  void frame(double x, double y) {
    picture_.line(x, y, x, y + kPanelHeight, kFaint);
    picture_.line(x, y + kPanelHeight, x + kPanelWidth, y + kPanelHeight, kFaint);
  }
  void nothing(double x, double y) {
    picture_.text(x + 0.5 * kPanelWidth, y + 0.5 * kPanelHeight + 4.0, "cannot tell", kGrey, 12,
                  "middle");
  }
  void verdicts(double x, double y, std::size_t channel) {
    for (std::size_t k = 0; k < trend_.periods.size(); ++k) {
      const ChannelPeriod& of = trend_.periods[k].channels[channel];
      double from = left(x, k);
      for (const auto& [share, colour] :
           {std::pair{of.match, kBlue}, std::pair{of.mismatch, kOrange},
            std::pair{of.undetermined, kFaint}}) {
        const double width = share * kPanelWidth / periods_;
        if (width > 0.05) picture_.rect(from, y + kPanelHeight + 2.0, width, kStrip, colour);
        from += width;
      }
    }
  }
  void mark(double x, double y, const std::string& mv, const std::string& cv) {
    for (const Change& change : findings_.changes)
      if (change.mv == mv && change.cv == cv)
        picture_.line(left(x, change.first), y, left(x, change.first), y + kPanelHeight, kOrange,
                      1.2, "4 3");
  }

  const Trend& trend_;
  const Findings& findings_;
  Picture& picture_;
  double periods_;
};

double row(std::size_t index) {
  return kTop + static_cast<double>(index) * (kPanelHeight + kRowGap);
}

std::vector<std::string> lines_of(const Trend& trend, const Findings& findings,
                                  const report::MomentText& moment) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& text) {
    const std::string wrapped = report::wrapped(text, 0, kWordsWidth);
    for (std::size_t from = 0; from < wrapped.size();) {
      const std::size_t end = wrapped.find('\n', from);
      lines.push_back(wrapped.substr(from, end - from));
      from = end + 1;
    }
  };
  for (const Change& change : findings.changes) add(words_of(trend, change, moment));
  for (const Standing& standing : findings.standing) add(words_of(trend, standing, moment));
  for (const Silence& silence : findings.silent) add("cannot tell: " + words_of(trend, silence));
  add(words_of_rate(trend, findings));
  return lines;
}

}  // namespace

std::string to_svg(const Trend& trend, const Findings& findings, const files::TimeZone* zone) {
  const report::MomentText moment(trend.periods.back().until_ns, trend.head.sample_time_s, zone);
  Picture picture;
  Panels panels(trend, findings, picture);
  const std::size_t cvs = trend.head.cvs.size();
  const std::size_t inputs = cvs == 0 ? 0 : trend.head.channels.size() / cvs;
  std::vector<std::string> labels;
  double labels_width = kLabels;
  for (std::size_t i = 0; i < inputs; ++i) {
    labels.push_back(report::shortened(printable(trend.head.channels[i * cvs].mv), kLongestLabel));
    labels_width =
        std::max(labels_width, kCharacter * static_cast<double>(report::columns_of(labels[i])));
  }
  const auto column = [labels_width](std::size_t index) {
    return kMargin + labels_width + static_cast<double>(index) * (kPanelWidth + kGap);
  };
  const std::string title =
      printable(trend.head.unit) + ", by " + std::string(to_string(trend.step)) + moment.zone();
  picture.text(kMargin, 28.0, title, kInk, 16, "start", true);
  picture.text(
      kMargin, 46.0,
      "Top: RMS error of predictions " +
          number_text(static_cast<double>(trend.head.horizon_samples) * trend.head.sample_time_s) +
          " s ahead. Below: gain error with 95 % interval; strip: match, mismatch "
          "(orange), undetermined (grey).",
      kGrey, 11);
  picture.text(kMargin, row(0) + 0.5 * kPanelHeight, "prediction", kInk, 12);
  picture.text(kMargin, row(0) + 0.5 * kPanelHeight + kLine, "error", kInk, 12);
  for (std::size_t j = 0; j < cvs; ++j) {
    const CvHead& cv = trend.head.cvs[j];
    picture.text(column(j), kTop - 8.0,
                 printable(cv.cv) + (cv.unit.empty() ? "" : ", " + printable(cv.unit)), kInk, 12,
                 "start", true);
    panels.errors(column(j), row(0), j);
    for (std::size_t i = 0; i < inputs; ++i) panels.gain(column(j), row(i + 1), i * cvs + j);
    panels.axis(column(j), row(inputs) + kPanelHeight + kStrip + 16.0);
  }
  for (std::size_t i = 0; i < inputs; ++i)
    picture.text(kMargin, row(i + 1) + 0.5 * kPanelHeight, labels[i], kInk, 12, "start", true);
  double y = row(inputs) + kPanelHeight + kStrip + 44.0;
  for (const std::string& line : lines_of(trend, findings, moment)) {
    picture.text(kMargin, y, line);
    y += kLine;
  }
  const double width = std::max(column(cvs), 760.0);
  return picture.svg(width, y + kMargin, title);
}

}  // namespace mpm::history
