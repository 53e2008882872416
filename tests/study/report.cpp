#include "tests/study/report.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace mpm::study {
namespace {

using Row = std::vector<std::string>;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// Two digits that count.
std::string percent_number(double share) {
  const double percent = 100.0 * share;
  if (percent == 0.0 || percent >= 9.95) return text("%.0f", percent);
  if (percent >= 0.995) return text("%.1f", percent);
  return text("%.2g", percent);
}

std::string percent(const Share* share) {
  if (share == nullptr) return "";
  return percent_number(share->rate()) + " % (" + percent_number(share->interval.low) + " to " +
         percent_number(share->interval.high) + ")";
}

std::string of(const Share* share) {
  return share == nullptr ? ""
                          : text("%lld of %lld", static_cast<long long>(share->hits),
                                 static_cast<long long>(share->total));
}

/// "3 of 1800, 0.17 % (...)"
std::string of_percent(const Share* share) {
  return share == nullptr ? "" : of(share) + ", " + percent(share);
}

std::string samples_text(double value) {
  return std::isfinite(value) ? text("%.0f", value) : std::string("never");
}

std::string quartiles_text(const Quartiles& quartiles) {
  if (quartiles.count == 0) return "";
  return samples_text(quartiles.median) + " (" + samples_text(quartiles.first) + " to " +
         samples_text(quartiles.third) + ")";
}

std::string seeds_text(const Experiment& experiment) {
  return text("%llu-%llu", static_cast<unsigned long long>(experiment.seeds.first),
              static_cast<unsigned long long>(experiment.seeds.last));
}

std::string large_number(double value) {
  if (!std::isfinite(value)) return "no limit";
  if (value >= 1e6) return text("%.2g million", value / 1e6);
  return text("%.0f", value);
}

/// In bytes that start a character, for aligned columns.
std::size_t width(const std::string& cell) {
  return static_cast<std::size_t>(std::count_if(cell.begin(), cell.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string render_rows(const std::vector<Row>& rows) {
  if (rows.size() < 2) return "";
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  std::string out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += "|";
    for (std::size_t c = 0; c < rows[r].size(); ++c)
      out += " " + rows[r][c] + std::string(widths[c] - width(rows[r][c]), ' ') + " |";
    out += "\n";
    if (r > 0) continue;
    out += "|";
    for (const std::size_t cells : widths) out += std::string(cells + 2, '-') + "|";
    out += "\n";
  }
  return out;
}

std::vector<int> reading_times(const Experiment& experiment) {
  std::vector<int> times = experiment.also_at;
  times.push_back(experiment.samples);
  return times;
}

std::vector<Row> healthy_rows(const std::vector<const Summary*>& summaries) {
  std::vector<Row> rows = {{"experiment", "N", "seeds", "p < 0.05", "p < 0.01", "p < 0.001",
                            "p < 0.0001", "runs with p < 0.01 / channels",
                            "runs with a false mismatch", "false alarms"}};
  for (const Summary* summary : summaries) {
    const Experiment& experiment = summary->experiment;
    for (const int at : reading_times(experiment))
      rows.push_back({experiment.name, std::to_string(at), seeds_text(experiment),
                      percent(summary->find("healthy_p_0.05", at)),
                      percent(summary->find("healthy_p_0.01", at)),
                      percent(summary->find("healthy_p_0.001", at)),
                      of(summary->find("healthy_p_0.0001", at)),
                      percent(summary->find("family_p", at)),
                      percent(summary->find("false_mismatch_runs", at)),
                      at == experiment.samples ? std::to_string(summary->false_alarms) : ""});
  }
  return rows;
}

std::vector<Row> verdict_rows(const std::vector<const Summary*>& summaries) {
  Row header = {"experiment", "N", "seeds", "channels"};
  for (const std::string& verdict : verdict_names()) {
    header.push_back(verdict);
    std::replace(header.back().begin(), header.back().end(), '_', ' ');
  }
  std::vector<Row> rows = {header};
  for (const Summary* summary : summaries) {
    const Experiment& experiment = summary->experiment;
    for (const int at : reading_times(experiment)) {
      for (const std::string truth : {"healthy", "wrong"}) {
        if (summary->find(truth + "_match", at) == nullptr) continue;
        Row row = {experiment.name, std::to_string(at), seeds_text(experiment), truth};
        for (const std::string& verdict : verdict_names()) {
          const Share* share = summary->find(truth + "_" + verdict, at);
          row.push_back(share == nullptr || share->hits == 0 ? "0" : percent(share));
        }
        rows.push_back(row);
      }
    }
  }
  return rows;
}

std::vector<Row> power_rows(const std::vector<const Summary*>& summaries) {
  std::vector<Row> rows = {{"experiment", "N", "seeds", "wrong channels called mismatch",
                            "wrong ones on top", "runs with a right alarm", "first alarm right",
                            "samples to it, median (quartiles)", "healthy channels called mismatch",
                            "false alarms"}};
  for (const Summary* summary : summaries) {
    const Experiment& experiment = summary->experiment;
    for (const int at : reading_times(experiment)) {
      const bool end = at == experiment.samples;
      rows.push_back({experiment.name, std::to_string(at), seeds_text(experiment),
                      of_percent(summary->find("wrong_mismatch", at)),
                      percent(summary->find("ranked", at)), end ? of(summary->find("alarmed")) : "",
                      end ? of(summary->find("first_alarm_right")) : "",
                      end ? quartiles_text(summary->alarm_delay) : "",
                      of_percent(summary->find("healthy_mismatch", at)),
                      end ? std::to_string(summary->false_alarms) : ""});
    }
  }
  return rows;
}

std::vector<Row> change_rows(const std::vector<const Summary*>& summaries) {
  std::vector<Row> rows = {{"experiment", "N", "seeds", "runs with a right alarm",
                            "samples to it, median (quartiles)", "first alarm right",
                            "alarms right", "false alarms", "healthy channels in alarm at the end",
                            "cleared after the return", "samples to that, median (quartiles)"}};
  for (const Summary* summary : summaries) {
    const Experiment& experiment = summary->experiment;
    rows.push_back(
        {experiment.name, std::to_string(experiment.samples), seeds_text(experiment),
         of_percent(summary->find("alarmed")), quartiles_text(summary->alarm_delay),
         of_percent(summary->find("first_alarm_right")), of_percent(summary->find("alarms_right")),
         std::to_string(summary->false_alarms), of_percent(summary->find("healthy_in_alarm")),
         of_percent(summary->find("cleared_after_return")), quartiles_text(summary->clear_delay)});
  }
  return rows;
}

std::vector<Row> run_length_rows(const std::vector<const Summary*>& summaries) {
  std::vector<Row> rows = {{"experiment", "runs x samples", "seeds", "channels", "false alarms",
                            "samples between them", "95 % interval",
                            "time in mismatch of a channel"}};
  for (const Summary* summary : summaries) {
    const auto samples = static_cast<double>(summary->samples);
    const Interval& interval = summary->false_alarms_interval;
    const bool none = summary->false_alarms == 0;
    rows.push_back({summary->experiment.name,
                    text("%lld x %d", static_cast<long long>(summary->runs - summary->diverged),
                         summary->experiment.samples),
                    seeds_text(summary->experiment), std::to_string(summary->channels),
                    std::to_string(summary->false_alarms),
                    none ? "" : large_number(samples / static_cast<double>(summary->false_alarms)),
                    none ? "more than " + large_number(samples / interval.high)
                         : large_number(samples / interval.high) + " to " +
                               large_number(samples / interval.low),
                    percent(summary->find("tail_mismatch"))});
  }
  return rows;
}

std::vector<Row> tail_rows(const std::vector<const Summary*>& summaries) {
  Row header = {"experiment", "samples", "evaluations"};
  for (const double level : kTailLevels) header.push_back(text("p < %.0e", level));
  std::vector<Row> rows = {header};
  for (const Summary* summary : summaries) {
    for (std::size_t bin = 0; bin < kTailBins.size(); ++bin) {
      const std::string from = "_from_" + std::to_string(kTailBins[bin]);
      Row row = {summary->experiment.name,
                 bin + 1 < kTailBins.size()
                     ? text("%lld to %lld", static_cast<long long>(kTailBins[bin]),
                            static_cast<long long>(kTailBins[bin + 1]))
                     : text("from %lld", static_cast<long long>(kTailBins[bin])),
                 ""};
      for (const double level : kTailLevels) {
        const Share* share = summary->find("tail_" + text("%g", level) + from);
        if (share == nullptr) break;
        row[2] = std::to_string(share->total);
        row.push_back(share->hits == 0
                          ? "0"
                          : text("x %.2g (%.2g to %.2g)", share->rate() / level,
                                 share->interval.low / level, share->interval.high / level));
      }
      if (row.size() == header.size()) rows.push_back(row);
    }
  }
  return rows;
}

std::vector<Row> grid_rows(const std::vector<const Summary*>& summaries) {
  std::vector<std::string> labels, columns;
  for (const Summary* summary : summaries) {
    const Experiment& experiment = summary->experiment;
    if (std::find(labels.begin(), labels.end(), experiment.row) == labels.end())
      labels.push_back(experiment.row);
    if (std::find(columns.begin(), columns.end(), experiment.column) == columns.end())
      columns.push_back(experiment.column);
  }
  Row header = {"error", "N"};
  header.insert(header.end(), columns.begin(), columns.end());
  header.push_back("healthy channels called mismatch");
  std::vector<Row> rows = {header};
  for (const std::string& label : labels) {
    std::vector<int> times;
    for (const Summary* summary : summaries)
      if (summary->experiment.row == label) times = reading_times(summary->experiment);
    for (const int at : times) {
      Row row = {label, std::to_string(at)};
      row.resize(header.size());
      Count wrongly;
      for (const Summary* summary : summaries) {
        if (summary->experiment.row != label) continue;
        const auto column =
            std::find(columns.begin(), columns.end(), summary->experiment.column) - columns.begin();
        row[static_cast<std::size_t>(2 + column)] = percent(summary->find("wrong_mismatch", at));
        if (const Share* share = summary->find("healthy_mismatch", at)) {
          wrongly.hits += share->hits;
          wrongly.total += share->total;
        }
      }
      const Share wrong = share_of({wrongly});
      row.back() = of_percent(&wrong);
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<Row> rows_of(TableKind kind, const std::vector<const Summary*>& summaries) {
  switch (kind) {
    case TableKind::kHealthy:
      return healthy_rows(summaries);
    case TableKind::kVerdicts:
      return verdict_rows(summaries);
    case TableKind::kPower:
      return power_rows(summaries);
    case TableKind::kChange:
      return change_rows(summaries);
    case TableKind::kGrid:
      return grid_rows(summaries);
    case TableKind::kRunLength:
      return run_length_rows(summaries);
    default:
      return tail_rows(summaries);
  }
}

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json quartiles_json(const Quartiles& quartiles) {
  return {{"count", quartiles.count},
          {"first", number(quartiles.first)},
          {"median", number(quartiles.median)},
          {"third", number(quartiles.third)}};
}

}  // namespace

bool matches(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::string render(const Table& table, const std::vector<Summary>& summaries) {
  std::vector<const Summary*> chosen;
  for (const std::string& pattern : table.experiments)
    for (const Summary& summary : summaries)
      if (matches(pattern, summary.experiment.name) &&
          std::find(chosen.begin(), chosen.end(), &summary) == chosen.end())
        chosen.push_back(&summary);
  return chosen.empty() ? "" : render_rows(rows_of(table.kind, chosen));
}

std::string to_json(const std::vector<Summary>& summaries) {
  Json all = Json::array();
  for (const Summary& summary : summaries) {
    const Experiment& experiment = summary.experiment;
    Json one = {{"name", experiment.name},
                {"unit", experiment.unit},
                {"scenario", experiment.scenario},
                {"samples_per_run", experiment.samples},
                {"seeds", {experiment.seeds.first, experiment.seeds.last}},
                {"runs", summary.runs},
                {"diverged", summary.diverged},
                {"channels", summary.channels},
                {"samples", summary.samples},
                {"wall_s", summary.wall_s},
                {"alarm_delay", quartiles_json(summary.alarm_delay)},
                {"clear_delay", quartiles_json(summary.clear_delay)},
                {"right_alarms", summary.right_alarms},
                {"false_alarms", summary.false_alarms},
                {"alarms_after_return", summary.alarms_after_return},
                {"false_alarms_low", summary.false_alarms_interval.low},
                {"false_alarms_high", summary.false_alarms_interval.high}};
    one["metrics"] = Json::array();
    for (const Metric& metric : summary.metrics)
      one["metrics"].push_back({{"name", metric.name},
                                {"at", metric.at},
                                {"hits", metric.share.hits},
                                {"total", metric.share.total},
                                {"design_effect", metric.share.design_effect},
                                {"low", metric.share.interval.low},
                                {"high", metric.share.interval.high}});
    all.push_back(one);
  }
  return all.dump(1) + "\n";
}

std::string replace_part(const std::string& text, const std::string& name,
                         const std::string& content) {
  const std::string begin = "<!-- study:begin " + name + " -->\n";
  const std::string end = "<!-- study:end " + name + " -->";
  const std::size_t from = text.find(begin);
  const std::size_t to = text.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from + begin.size())
    throw std::invalid_argument("no part `" + name + "` between study markers");
  return text.substr(0, from + begin.size()) + content + text.substr(to);
}

}  // namespace mpm::study
