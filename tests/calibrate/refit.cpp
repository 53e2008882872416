#include "tests/calibrate/refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm::calibrate {
namespace {

namespace few_rows = calibration::few_rows;

using Sample = std::vector<const Run*>;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  if (values[below] == values[above]) return values[below];  // both may be infinite
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

/// `estimate` of all runs, and its interval over runs drawn with replacement.
Refit bootstrap(const std::vector<Run>& runs,
                const std::function<double(const Sample&)>& estimate) {
  constexpr int kDraws = 400;
  Sample sample;
  for (const Run& run : runs) sample.push_back(&run);
  Refit refit;
  refit.fitted = estimate(sample);
  std::mt19937_64 random(1);
  std::vector<double> drawn;
  for (int k = 0; k < kDraws; ++k) {
    // by hand: what std::uniform_int_distribution draws differs between libraries
    for (const Run*& run : sample) run = &runs[random() % runs.size()];
    drawn.push_back(estimate(sample));
  }
  refit.low = quantile(drawn, 0.025);
  refit.high = quantile(drawn, 0.975);
  return refit;
}

/// As `ChannelEvaluator` has it: of the two tests the one that says more, doubled.
double p_value(const Reading& reading) {
  const double c = reading.columns_per_freedom;
  double p =
      f_upper_tail(reading.block / block_inflation(c), reading.block_freedom, reading.freedom);
  if (reading.directed_freedom == 0) return p;
  p = std::min(p, f_upper_tail(reading.directed / directed_inflation(c), reading.directed_freedom,
                               reading.freedom));
  return std::min(1.0, 2.0 * p);
}

/// Readings by rows per column, and those of them with a p-value below a level.
struct Tail {
  std::array<int, std::size(kRowsPerColumn)> below{}, total{};

  [[nodiscard]] double share(std::size_t rows) const {
    return total[rows] > 0 ? static_cast<double>(below[rows]) / total[rows] : 0.0;
  }
};

std::vector<Tail> tails(const std::vector<Run>& runs, double level) {
  std::vector<Tail> result;
  for (const Run& run : runs) {
    Tail& tail = result.emplace_back();
    for (const Reading& reading : run.readings) {
      const auto rows = static_cast<std::size_t>(
          std::find(std::begin(kRowsPerColumn), std::end(kRowsPerColumn), reading.rows_per_column) -
          std::begin(kRowsPerColumn));
      ++tail.total[rows];
      tail.below[rows] += p_value(reading) < level ? 1 : 0;
    }
  }
  return result;
}

void add(const Tail& tail, Tail& sum) {
  for (std::size_t k = 0; k < tail.total.size(); ++k) {
    sum.total[k] += tail.total[k];
    sum.below[k] += tail.below[k];
  }
}

}  // namespace

Refit refit_few_rows(const std::vector<Run>& runs, Test test, int fewest, int most) {
  constexpr double kLevel = 0.05;
  std::vector<std::vector<double>> factors;
  for (const Run& run : runs) {
    std::vector<double>& of_run = factors.emplace_back();
    for (const Reading& reading : run.readings) {
      const int freedom =
          test == Test::kDirected ? reading.directed_freedom : reading.block_freedom;
      if (freedom == 0 || reading.rows_per_column < fewest || reading.rows_per_column > most)
        continue;
      const double statistic = test == Test::kDirected ? reading.directed : reading.block;
      const double c = reading.columns_per_freedom;
      const double square =
          test == Test::kDirected ? few_rows::kDirectedSquare : few_rows::kBlockSquare;
      of_run.push_back((statistic / f_quantile(kLevel, freedom, reading.freedom) - 1.0) / c -
                       square * c);
    }
  }
  Refit refit = bootstrap(runs, [&](const Sample& sample) {
    std::vector<double> all;
    for (const Run* run : sample) {
      const std::vector<double>& of_run = factors[static_cast<std::size_t>(run - runs.data())];
      all.insert(all.end(), of_run.begin(), of_run.end());
    }
    return quantile(std::move(all), 1.0 - kLevel);
  });
  refit.now = test == Test::kDirected ? few_rows::kDirected : few_rows::kBlock;
  return refit;
}

Refit refit_rows_needed(const std::vector<Run>& runs, double level, double tolerance) {
  const std::vector<Tail> by_run = tails(runs, level);
  return bootstrap(runs, [&](const Sample& sample) {
    Tail sum;
    for (const Run* run : sample) add(by_run[static_cast<std::size_t>(run - runs.data())], sum);
    double fewest = std::numeric_limits<double>::infinity();
    for (std::size_t k = std::size(kRowsPerColumn); k-- > 0 && sum.share(k) <= tolerance * level;)
      fewest = kRowsPerColumn[k];
    return fewest;
  });
}

Refit refit_clipped_share(const std::vector<Run>& runs, double share) {
  Refit refit = bootstrap(runs, [share](const Sample& sample) {
    std::vector<double> all;
    for (const Run* run : sample)
      all.insert(all.end(), run->clipped_shares.begin(), run->clipped_shares.end());
    return quantile(std::move(all), share);
  });
  refit.larger_is_stricter = false;
  return refit;
}

std::string tail_table(const std::vector<Run>& runs, const std::vector<double>& levels) {
  std::array<char, 96> text{};
  std::string table = "| rows per column |";
  std::string rule = "|---|";
  std::vector<Tail> sums;
  for (const double level : levels) {
    std::snprintf(text.data(), text.size(), " p < %g |", level);
    table += text.data();
    rule += "---|";
    Tail& sum = sums.emplace_back();
    for (const Tail& tail : tails(runs, level)) add(tail, sum);
  }
  table += "\n" + rule + "\n";
  for (std::size_t k = 0; k < std::size(kRowsPerColumn); ++k) {
    table += "| " + std::to_string(kRowsPerColumn[k]) + " |";
    for (const Tail& sum : sums) {
      std::snprintf(text.data(), text.size(), " %.3g %% (%d of %d) |", 100.0 * sum.share(k),
                    sum.below[k], sum.total[k]);
      table += text.data();
    }
    table += "\n";
  }
  return table;
}

}  // namespace mpm::calibrate
