// Reruns every detection rate that docs/validation.md claims: closed loops and their monitors, in
// process, over many seeds.
#include <CLI/CLI.hpp>
#include <chrono>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/study/experiment.hpp"
#include "tests/study/parallel.hpp"
#include "tests/study/report.hpp"
#include "tests/study/run.hpp"
#include "tests/study/summary.hpp"

namespace mpm::study {
namespace {

struct Options {
  std::vector<std::string> only;
  std::string seeds, json, markdown;
  int threads = 0;
  bool short_version = false;
  bool list = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("--only", options.only,
                 "experiments or tables by name or pattern, such as 's?_*'");
  CLI::Option* seeds = app.add_option(
      "--seeds", options.seeds, "FIRST-LAST instead of each experiment's own; tuning: from 100001");
  app.add_option("--threads", options.threads, "instead of one per core")
      ->check(CLI::PositiveNumber);
  app.add_option("--json", options.json, "write every number to FILE");
  CLI::Option* markdown =
      app.add_option("--markdown", options.markdown, "rewrite the tables of FILE between markers");
  CLI::Option* short_version =
      app.add_flag("--short", options.short_version, "the short version, which checks bounds");
  app.add_flag("--list", options.list, "print the experiments and run none");
  markdown->excludes(seeds)->excludes(short_version);
}

SeedRange parse_seeds(const std::string& text) {
  try {
    std::size_t used = 0;
    const unsigned long long first = std::stoull(text, &used);
    if (used == text.size()) return {first, first};
    if (text[used] == '-') {
      const std::string rest = text.substr(used + 1);
      const unsigned long long last = std::stoull(rest, &used);
      if (used == rest.size() && last >= first) return {first, last};
    }
  } catch (const std::exception&) {
  }
  throw std::invalid_argument("--seeds: not FIRST-LAST: " + text);
}

bool is_in(const Table& table, const std::string& experiment) {
  for (const std::string& pattern : table.experiments)
    if (matches(pattern, experiment)) return true;
  return false;
}

bool is_wanted(const Study& study, const Experiment& experiment,
               const std::vector<std::string>& only) {
  if (only.empty()) return true;
  for (const std::string& pattern : only) {
    if (matches(pattern, experiment.name)) return true;
    for (const Table& table : study.tables)
      if (matches(pattern, table.name) && is_in(table, experiment.name)) return true;
  }
  return false;
}

void write_file(const std::string& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary);
  out << content;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file);
}

std::string read_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Tables of which an experiment was left out on request are left as they are.
void write_markdown(const Study& study, const Options& options,
                    const std::vector<Summary>& summaries) {
  std::string text = read_file(options.markdown);
  for (const Table& table : study.tables) {
    bool complete = true;
    for (const Experiment& experiment : study.experiments)
      complete = complete &&
                 (!is_in(table, experiment.name) || is_wanted(study, experiment, options.only));
    const std::string rendered = render(table, summaries);
    if (complete && !rendered.empty())
      text = replace_part(text, table.name, "\n" + rendered + "\n");
    else
      std::cerr << "table '" << table.name << "' left as it is: not all of it was run\n";
  }
  write_file(options.markdown, text);
}

/// False where a bound was broken.
bool report_bounds(const Summary& summary) {
  bool kept = true;
  for (const Finding& finding : check_bounds(summary)) {
    std::cout << (finding.kept ? "  holds   " : "  BROKEN  ") << summary.experiment.name << ": "
              << finding.text << '\n';
    kept = kept && finding.kept;
  }
  return kept;
}

int run(const Options& options) {
  Study study = options.short_version ? short_study() : full_study();
  const int threads = options.threads > 0
                          ? options.threads
                          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<Summary> summaries;
  std::vector<std::string> skipped;
  bool kept = true;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto seconds_since = [](Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
  };
  for (Experiment& experiment : study.experiments) {
    if (!is_wanted(study, experiment, options.only)) continue;
    if (!options.seeds.empty()) experiment.seeds = parse_seeds(options.seeds);
    if (options.list) {
      std::cout << experiment.name << ": " << experiment.unit << ", " << experiment.scenario << ", "
                << experiment.samples << " samples, seeds " << experiment.seeds.first << "-"
                << experiment.seeds.last << '\n';
      continue;
    }
    const Clock::time_point start = Clock::now();
    std::string why_not;
    const std::optional<Prepared> prepared = prepare(experiment, why_not);
    if (!prepared) {
      std::cerr << "SKIPPED " << experiment.name << ": " << why_not << '\n';
      skipped.push_back(experiment.name);
      continue;
    }
    summaries.push_back(summarise(experiment, run_all(*prepared, threads, experiment.name)));
    Summary& summary = summaries.back();
    summary.wall_s = seconds_since(start);
    std::cerr << experiment.name << ": " << summary.runs << " runs, " << summary.samples
              << " samples, " << summary.wall_s << " s"
              << (summary.diverged > 0 ? ", " + std::to_string(summary.diverged) + " DIVERGED" : "")
              << '\n';
    if (options.seeds.empty()) kept = report_bounds(summary) && kept;
  }
  if (options.list) return 0;
  std::cout << "\nShares with 95 % intervals in brackets.\n";
  for (const Table& table : study.tables) {
    const std::string rendered = render(table, summaries);
    if (!rendered.empty()) std::cout << "\n" << table.name << "\n\n" << rendered;
  }
  std::cout << "\n" << seconds_since(begin) << " s on " << threads << " threads\n";
  for (const std::string& name : skipped) std::cout << "SKIPPED " << name << '\n';
  if (!options.json.empty()) write_file(options.json, to_json(summaries));
  if (!options.markdown.empty()) write_markdown(study, options, summaries);
  return kept ? 0 : 1;
}

}  // namespace
}  // namespace mpm::study

int main(int argc, char** argv) {
  try {
    CLI::App app("Measures the detection rates of the monitor on simulated closed loops.");
    mpm::study::Options options;
    mpm::study::declare(app, options);
    CLI11_PARSE(app, argc, argv);
    return mpm::study::run(options);
  } catch (const std::exception& error) {
    std::cerr << "mpm_study: " << error.what() << '\n';
    return 2;
  }
}
