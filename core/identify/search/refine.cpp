#include "core/identify/search/refine.hpp"

#include <algorithm>
#include <array>

#include "core/identify/causes/candidates.hpp"
#include "core/identify/causes/square_waves.hpp"

namespace mpm {

using Eigen::Index;

void place_onset(Trials& trials, Trial& trial) {
  Problem& problem = trials.problem();
  const Index margin = problem.samples() / 50 + 5;
  Index reach = std::max<Index>(2, problem.samples() / 12);
  while (reach >= 2) {
    bool moved = false;
    for (const Effect& other : other_onsets(trial.candidate, reach, problem.samples())) {
      Trial next = trials.attempt(other, 4);
      if (next.odds > trial.odds + 1e-9) {
        trial = std::move(next);
        moved = true;
      }
    }
    if (!knows_onset(trial.candidate) && reach > 20) {  // the best row near, all else held
      const Index first = std::max(margin, trial.candidate.onset - reach);
      const Index last = std::min(problem.samples() - margin, trial.candidate.onset + reach);
      Effect other = trial.candidate;
      if (first < last) other.onset = problem.best_onset(trial.fit, first, last);
      if (other.onset != trial.candidate.onset) {
        Trial next = trials.attempt(other, 5);
        if (next.odds > trial.odds + 1e-9) {
          trial = std::move(next);
          moved = true;
        }
      }
    }
    if (!moved) reach /= 2;
  }
}

void try_valves(Trials& tries, Screening& screening, std::vector<Trial>& trials) {
  const Effect best = trials[0].candidate;
  const bool play = best.subject.kind == "deadband";
  if (!play && best.subject.cause != Cause::kStiction) return;
  const auto valve = std::find_if(trials.begin(), trials.end(), [&](const Trial& trial) {
    return trial.candidate.subject.cause == Cause::kStiction &&
           trial.candidate.subject.input == best.subject.input;
  });
  if (valve == trials.end()) return;
  const Effect like = valve->candidate;
  const double width = best.value(play ? "width" : "band", 0.0);
  std::vector<std::pair<double, Effect>> scored;
  for (int percent = 80; percent < 165; percent += 5) {
    const double factor = 0.01 * percent;
    for (const double jump : {0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0})
      for (const bool slips_once : {false, true}) {
        tries.tell();
        Effect effect = like;
        effect.slips_once = slips_once;
        effect.coordinates[0].value = factor * width;
        effect.coordinates[1].value = jump * factor * width;
        effect.coordinates[0].step = 0.05 * factor * width;
        effect.coordinates[1].step = -0.05 * factor * width;
        scored.emplace_back(screening.score(effect), std::move(effect));
      }
  }
  std::sort(scored.begin(), scored.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < 6; ++i) trials.push_back(tries.attempt(scored[i].second, 6));
}

void polish(Trials& trials, Trial& trial) {
  constexpr std::array<double, 6> kReach = {16.0, 8.0, 4.0, 2.0, 1.0, 0.5};  // rows
  for (const double reach : kReach)
    for (bool moved = is_square_wave(trial.candidate); moved;) {
      moved = false;
      for (const Effect& other : other_edges(trial.candidate, reach, trials.problem())) {
        Trial next = trials.attempt(other, 2);
        if (next.odds <= trial.odds + 1e-6) continue;
        trial = std::move(next);
        moved = true;
        break;
      }
    }
  const Cause cause = trial.candidate.subject.cause;
  if (cause != Cause::kStiction && trial.candidate.subject.kind != "deadband") return;
  constexpr std::array<double, 6> kSteps = {0.3, 0.15, 0.075, 0.0375, 0.01875, 0.009375};
  for (const double step : kSteps) {
    const double factor = 1.0 + step;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < trial.candidate.coordinates.size(); ++i) {
        for (const double by : {factor, 1.0 / factor}) {
          Effect other = trial.candidate;
          Coordinate& c = other.coordinates[i];
          c.value = std::clamp(c.value * by, c.low, c.high);
          Trial next = trials.attempt(other, 2);
          if (next.odds > trial.odds + 1e-6) {
            trial = std::move(next);
            moved = true;
          }
        }
      }
    }
  }
}

}  // namespace mpm
