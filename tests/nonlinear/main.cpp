// Which test sees which nonlinear mismatch, and how often one where there is none: closed loops and
// their monitors, in process, over many seeds.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "config/choice.hpp"
#include "tests/nonlinear/compare.hpp"
#include "tests/nonlinear/one_run.hpp"
#include "tests/study/interval.hpp"
#include "tests/study/report.hpp"

namespace mpm::nonlinear {
namespace {

struct Options {
  std::string only = "*", test = "polynomial", markdown, table, json;
  std::uint64_t first = 100001;
  int runs = 20, samples = 3000, threads = 2;
  bool methods = false;
};

std::string percent(const study::Share& share) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.1f %% [%.1f, %.1f]", 100.0 * share.rate(),
                100.0 * share.interval.low, 100.0 * share.interval.high);
  return share.total > 0 ? text.data() : "-";
}

/// Shares over the runs of a case; each is of channels, but for `found`, which is of runs.
struct Score {
  study::Share below, called, undetermined;  ///< of channels that are linear
  study::Share right, linear;  ///< of those that are not: by this test, the linear one
  study::Share found;          ///< some nonlinear channel
};

Score score(const Case& one, const std::vector<RunReadings>& runs) {
  std::vector<study::Count> below, called, undetermined, right, linear, found;
  for (const RunReadings& run : runs) {
    if (run.diverged) continue;
    study::Count run_below, run_called, run_undetermined, run_right, run_linear;
    for (std::size_t c = 0; c < run.channels.size(); ++c) {
      const Reading& reading = run.channels[c];
      const bool bent = std::find(one.nonlinear.begin(), one.nonlinear.end(),
                                  static_cast<int>(c)) != one.nonlinear.end();
      const bool said = reading.nonlinear.verdict == NonlinearVerdict::kNonlinear;
      const auto count = [](study::Count& of, bool hit) {
        of.hits += hit ? 1 : 0;
        ++of.total;
      };
      if (bent) {
        count(run_right, said);
        count(run_linear, reading.linear == Verdict::kMismatch);
        continue;
      }
      if (reading.nonlinear.statistic > 0.0) count(run_below, reading.nonlinear.p_value < 0.01);
      count(run_called, said);
      count(run_undetermined, reading.nonlinear.verdict == NonlinearVerdict::kUndetermined);
    }
    below.push_back(run_below);
    called.push_back(run_called);
    undetermined.push_back(run_undetermined);
    right.push_back(run_right);
    linear.push_back(run_linear);
    if (!one.nonlinear.empty()) found.push_back({run_right.hits > 0 ? 1 : 0, 1});
  }
  return {study::share_of(below), study::share_of(called), study::share_of(undetermined),
          study::share_of(right), study::share_of(linear), study::share_of(found)};
}

std::vector<RunReadings> run_all(const study::Prepared& prepared, const Options& options) {
  std::vector<RunReadings> runs(static_cast<std::size_t>(options.runs));
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < options.threads; ++t)
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < runs.size(); i = next++)
        runs[i] = run_case(prepared, options.first + i);
    });
  threads.clear();
  return runs;
}

void write(const Options& options, const std::string& part, const std::string& table) {
  if (options.markdown.empty()) return;
  std::ifstream in(options.markdown, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::ofstream out(options.markdown, std::ios::binary);
  out << study::replace_part(text, part, "\n" + table + "\n");
  if (!out) throw std::runtime_error("cannot write " + options.markdown);
}

void run(const Options& options) {
  NonlinearTest test = NonlinearTest::kPolynomial;
  for (const auto& choice : config::choices(NonlinearTest{}))
    if (choice.name == options.test) test = choice.kind;
  std::string table =
      "| case | linear channels with p < 0.01 | called nonlinear | undetermined | runs in which it "
      "is found | nonlinear channels called so | called mismatch by the linear test |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Case& one : all_cases()) {
    if (!study::matches(options.only, one.name)) continue;
    std::string why_not;
    const auto prepared = prepare_case(one, options.samples, test, why_not);
    if (!prepared) {
      std::cerr << "SKIPPED " << one.name << ": " << why_not << '\n';
      continue;
    }
    const Score of = score(one, run_all(*prepared, options));
    const std::string row = "| " + one.name + " | " + percent(of.below) + " | " +
                            percent(of.called) + " | " + percent(of.undetermined) + " | " +
                            percent(of.found) + " | " + percent(of.right) + " | " +
                            percent(of.linear) + " |\n";
    std::cout << row << std::flush;
    table += row;
  }
  write(options, options.table.empty() ? options.test : options.table, table);
}

constexpr int kCvs = 3;  // of the unit that methods are compared on

/// What docs/figures/methods.py draws.
void write_json(const Options& options, const std::vector<Blame>& blames) {
  nlohmann::ordered_json json = {{"first_seed", options.first}, {"methods", kMethodNames}};
  for (const Blame& blame : blames) {
    std::vector<int> linear;  // errors; channels as in `Case::nonlinear`
    for (const sim::ChannelChange& change : blame.of.changes)
      linear.push_back(kCvs * change.input + change.cv);
    json["cases"].push_back({{"name", blame.of.name},
                             {"runs", blame.runs},
                             {"nonlinear", blame.of.nonlinear},
                             {"linear", linear},
                             {"blamed", blame.blamed}});
  }
  std::ofstream out(options.json, std::ios::binary);
  out << json.dump(1) << '\n';
  out.close();
  if (!out) throw std::runtime_error("cannot write " + options.json);
}

void run_methods(const Options& options) {
  CompareOptions compared;
  compared.only = options.only;
  compared.first = options.first;
  compared.runs = options.runs;
  compared.threads = options.threads;
  const MethodScores scores = compare_methods(compared);
  write(options, "methods", scores.table);
  if (!options.json.empty()) write_json(options, scores.blames);
}

}  // namespace
}  // namespace mpm::nonlinear

int main(int argc, char** argv) {
  mpm::nonlinear::Options options;
  CLI::App app{
      "Scores the nonlinear test over seeds. Seeds 1 to 40 score; tuning takes 100001 on."};
  app.add_option("--only", options.only, "cases by name or pattern");
  app.add_option("--test", options.test, "polynomial, kernel or random_features");
  app.add_option("--first", options.first, "seed");
  app.add_option("--runs", options.runs, "seeds of each case");
  app.add_option("--samples", options.samples, "of each run");
  app.add_option("--threads", options.threads);
  app.add_option("--markdown", options.markdown, "rewrite a table of FILE between its markers");
  app.add_flag("--methods", options.methods,
               "all methods of the thesis beside each other on the nonlinear cases");
  app.add_option("--json", options.json,
                 "of --methods: write to FILE in how many runs each method blames each channel");
  app.add_option("--table", options.table, "its name, instead of the test's");
  CLI11_PARSE(app, argc, argv);
  try {
    options.methods ? mpm::nonlinear::run_methods(options) : mpm::nonlinear::run(options);
  } catch (const std::exception& error) {
    std::cerr << "mpm_nonlinear: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
