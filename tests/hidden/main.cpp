// Hides effects in simulated plants and scores how well `diagnose` finds them.
//
// Seeds below 1000 are for the scores that are published: nobody looks at them while tuning.
// Whoever tunes takes seeds from 100001 on, which are the default.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/hidden/report.hpp"
#include "tests/hidden/score_all.hpp"
#include "tests/hidden/write_case.hpp"
#include "tests/study/report.hpp"

namespace mpm::hidden {
namespace {

struct Options {
  std::vector<std::string> classes = {"all"};
  std::string seeds = "100001-100005", size = "full", setting = "plain", plant = "shell", markdown,
              folder;
  int samples = 3000;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool verbose = false;
  bool truth_only = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("--class", options.classes, "what is hidden, one or more of the classes, or all")
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "FIRST-LAST; below 1000: scores, from 100001: tuning")
      ->capture_default_str();
  app.add_option("--size", options.size, "half = half the deviation of the same draws")
      ->check(CLI::IsMember({"full", "half"}))
      ->capture_default_str();
  app.add_option("--setting", options.setting,
                 "hard = with model errors everywhere, uneven noise, other shapes")
      ->check(CLI::IsMember({"plain", "hard"}))
      ->capture_default_str();
  app.add_option("--plant", options.plant)
      ->check(CLI::IsMember({"shell", "wood_berry", "shell7x5", "all"}))
      ->capture_default_str();
  app.add_option("--samples", options.samples, "of a case; the last third validates")
      ->check(CLI::Range(300, 1000000))
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "threads")->check(CLI::PositiveNumber);
  app.add_option("--markdown", options.markdown,
                 "write the tables to FILE; where it exists, between the lines "
                 "<!-- study:begin hidden_SETTING_SIZE --> and <!-- study:end ... -->");
  app.add_option(
      "--write", options.folder,
      "write each case into this folder, as data, unit file and truth; diagnose nothing");
  app.add_flag("--verbose", options.verbose, "print every case, not only the wrong ones");
  app.add_flag("--truth-only", options.truth_only, "print what would be hidden; diagnose nothing");
}

std::vector<EffectClass> wanted_classes(const Options& options) {
  std::vector<EffectClass> result;
  for (const std::string& name : options.classes) {
    if (name == "all") return {kAllClasses.begin(), kAllClasses.end()};
    const std::optional<EffectClass> known = class_named(name);
    if (!known) {
      std::string all;
      for (const EffectClass effect_class : kAllClasses)
        all += std::string(" ") + name_of(effect_class);
      throw std::invalid_argument("--class: no class '" + name + "'; there are: all" + all);
    }
    result.push_back(*known);
  }
  return result;
}

std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text) {
  try {
    std::size_t used = 0;
    const std::uint64_t first = std::stoull(text, &used);
    if (used == text.size()) return {first, first};
    if (text[used] == '-') {
      const std::string rest = text.substr(used + 1);
      const std::uint64_t last = std::stoull(rest, &used);
      if (used == rest.size() && last >= first) return {first, last};
    }
  } catch (const std::exception&) {
  }
  throw std::invalid_argument("--seeds: not FIRST-LAST: " + text);
}

std::vector<CaseRequest> requests_of(const Options& options) {
  const auto [first, last] = parse_seeds(options.seeds);
  std::vector<std::string> plants = {options.plant == "shell" ? "shell3x3" : options.plant};
  if (options.plant == "all") plants = {kPlants.begin(), kPlants.end()};
  std::vector<CaseRequest> requests;
  for (const EffectClass effect_class : wanted_classes(options))
    for (const std::string& plant : plants)
      for (std::uint64_t seed = first; seed <= last; ++seed)
        requests.push_back({plant, effect_class, options.size == "half" ? Size::kHalf : Size::kFull,
                            options.setting == "hard" ? Setting::kHard : Setting::kPlain, seed,
                            options.samples});
  return requests;
}

void write_markdown(const Options& options, const std::string& tables) {
  std::string text = tables;
  if (std::filesystem::exists(options.markdown)) {
    std::ifstream in(options.markdown, std::ios::binary);
    const std::string old{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    text = study::replace_part(old, "hidden_" + options.setting + "_" + options.size,
                               "\n" + tables + "\n");
  }
  std::ofstream out(options.markdown, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + options.markdown);
}

int run(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::vector<CaseRequest> requests = requests_of(options);
  if (options.truth_only) {
    for (const CaseRequest& request : requests)
      std::cout << name_of(request.effect_class) << ' ' << request.plant << " seed " << request.seed
                << ": " << describe(draw_case(request)) << '\n';
    return 0;
  }
  if (!options.folder.empty()) {
    for (const CaseRequest& request : requests) write_case(draw_case(request), options.folder);
    return 0;
  }
  const std::vector<CaseScore> scores = score_all(requests, options.jobs);
  const std::string parameters = parameter_table(scores);
  const std::string tables =
      "Setting " + options.setting + ", size " + options.size + ", plant " + options.plant +
      ", seeds " + options.seeds + ", " + std::to_string(options.samples) +
      " samples a case. In brackets: 95 % interval. a / b: median and worst tenth.\n\n" +
      confusion_table(scores) + "\n" + class_table(scores) +
      (parameters.empty() ? "" : "\n" + parameters);
  std::cout << tables << '\n';
  for (const CaseScore& score : scores) {
    const bool right = score.cause_right && score.place_right.value_or(true);
    if (right && !options.verbose) continue;
    std::cout << (right               ? "right  "
                  : score.cause_right ? "PLACE  "
                                      : "WRONG  ")
              << line_of(score) << '\n';
  }
  std::cout << '\n'
            << std::chrono::duration<double>(Clock::now() - begin).count() << " s on "
            << options.jobs << " threads\n";
  if (!options.markdown.empty()) write_markdown(options, tables);
  return 0;
}

}  // namespace
}  // namespace mpm::hidden

int main(int argc, char** argv) {
  try {
    CLI::App app("Hides effects in simulated plants and scores how well `diagnose` finds them.");
    mpm::hidden::Options options;
    mpm::hidden::declare(app, options);
    CLI11_PARSE(app, argc, argv);
    return mpm::hidden::run(options);
  } catch (const std::invalid_argument& error) {
    std::cerr << "mpm_hidden: " << error.what() << '\n';
    return 3;
  } catch (const std::exception& error) {
    std::cerr << "mpm_hidden: " << error.what() << '\n';
    return 2;
  }
}
