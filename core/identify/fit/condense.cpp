#include "core/identify/fit/condense.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <variant>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// For how many rows the inputs are held, and at which of a run's rows they first move.
struct Hold {
  Index rows = 1;
  std::vector<Index> first;  ///< of each run
};

bool moves(const Recording& recording, Index row) {
  for (Index i = 0; i < recording.inputs.cols(); ++i) {
    const double step = recording.inputs(row, i) - recording.inputs(row - 1, i);
    if (std::isfinite(step) && step != 0.0) return true;
  }
  return false;
}

Hold hold_of(const Recording& recording) {
  Hold hold;
  Index period = 0, moved = 0;
  for (const Run& run : runs_of(recording)) {
    Index last = -1;
    hold.first.push_back(0);
    for (Index k = 1; k < run.count; ++k) {
      if (!moves(recording, run.first + k)) continue;
      if (last < 0) hold.first.back() = k;
      if (last >= 0) period = std::gcd(period, k - last);
      last = k;
      ++moved;
    }
  }
  if (moved >= kFewestMoves && period > 0) hold.rows = period;
  return hold;
}

/// Where the rows of an average begin: floor(offset + r every).
struct Grid {
  double offset = 0.0, every = 1.0;
  [[nodiscard]] Index row(Index r) const {
    return static_cast<Index>(offset + static_cast<double>(r) * every + kOfRow);
  }
  /// How many end within so many rows.
  [[nodiscard]] Index count(Index rows) const {
    auto count =
        static_cast<Index>(std::max(0.0, static_cast<double>(rows) - offset) / every + 1.0);
    while (count > 0 && row(count) > rows) --count;
    return count;
  }
};

/// Of each: the mean of the known values up to the next.
VectorXd means(const Eigen::Ref<const VectorXd>& values, const Grid& grid, Index count) {
  VectorXd result(count);
  for (Index r = 0; r < count; ++r) {
    double sum = 0.0, known = 0.0;
    for (const double value : values.segment(grid.row(r), grid.row(r + 1) - grid.row(r)))
      if (std::isfinite(value)) sum += value, known += 1.0;
    result(r) = known > 0.0 ? sum / known : kUnknown;
  }
  return result;
}

/// The last known value up to each of these rows, no older than half of what is averaged.
VectorXd readings(const Eigen::Ref<const VectorXd>& values, const Grid& grid, Index count) {
  VectorXd result(count);
  for (Index r = 0; r < count; ++r) {
    const Index at = grid.row(r);
    const auto oldest = static_cast<Index>(grid.every) / 2;
    Index k = at;
    while (k > 0 && at - k < oldest && !std::isfinite(values(k))) --k;
    result(r) = values(k);
  }
  return result;
}

/// One run, averaged.
Recording averaged_run(const Recording& run, const Grid& grid) {
  Recording result;
  result.sample_time_s = run.sample_time_s * grid.every;
  result.start_s = run.start_s + grid.offset * run.sample_time_s;
  const Index count = grid.count(run.samples());
  const auto each = [&](const MatrixXd& from, auto take) {
    MatrixXd to(count, from.cols());
    for (Index c = 0; c < from.cols(); ++c) to.col(c) = take(from.col(c), grid, count);
    return to;
  };
  result.inputs = each(run.inputs, means);
  result.aux = each(run.aux, means);
  result.cvs = each(run.cvs, readings);
  if (run.setpoints.cols() > 0) result.setpoints = each(run.setpoints, readings);
  return result;
}

/// Of each row: sum of (value - mean)^2 / variance over the set-points or, where none moves, the
/// inputs; means those of short pieces, so that what counts is how a signal moves, and not where it
/// was. What a loop does by itself must not choose: stretches in which disturbances are large, and
/// the inputs that answer them, make gains look smaller by several s.d.
VectorXd movement(const Recording& recording, Index piece) {
  VectorXd result = VectorXd::Zero(recording.samples());
  const auto add = [&](const MatrixXd& signals) {
    for (Index c = 0; c < signals.cols(); ++c) {
      VectorXd squares = VectorXd::Zero(result.size());
      for (Index first = 0; first < result.size(); first += piece) {
        const Index count = std::min(piece, result.size() - first);
        double sum = 0.0, known = 0.0;
        for (const double value : signals.col(c).segment(first, count))
          if (std::isfinite(value)) sum += value, known += 1.0;
        if (known == 0.0) continue;
        for (Index k = first; k < first + count; ++k) {
          const double off = signals(k, c) - sum / known;
          if (std::isfinite(off)) squares(k) = off * off;
        }
      }
      const double all = squares.sum();
      if (all > 0.0) result += squares / all;
    }
  };
  add(recording.setpoints);
  if (result.isZero(0.0)) add(recording.inputs);
  return result;
}

/// The first row of the `count` in a span that hold most of `moved`.
Index most_telling(const VectorXd& moved, const Run& span, Index count) {
  double sum = moved.segment(span.first, count).sum(), most = sum;
  Index best = span.first;
  for (Index first = span.first + 1; first + count <= span.first + span.count; ++first) {
    sum += moved(first + count - 1) - moved(first - 1);
    if (sum > most) most = sum, best = first;
  }
  return best;
}

void take_stretches(Index most_rows, Condensed& condensed) {
  const Recording& all = condensed.recording;
  const double share = static_cast<double>(most_rows) / static_cast<double>(all.samples());
  const Index longest = all.samples() / kStretches;
  const VectorXd moved = movement(all, std::max<Index>(1, most_rows / kStretches));
  std::vector<Recording> taken;
  std::vector<std::size_t> run_of;
  const std::vector<Run> runs = runs_of(all);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Index spans = std::max<Index>(1, (runs[r].count + longest / 2) / longest);
    for (Index s = 0; s < spans; ++s) {
      const Index first = runs[r].first + s * runs[r].count / spans,
                  end = runs[r].first + (s + 1) * runs[r].count / spans;
      const auto count = static_cast<Index>(share * static_cast<double>(end - first));
      if (count < kShortestRun) continue;
      taken.push_back(part(all, most_telling(moved, {first, end - first}, count), count));
      run_of.push_back(condensed.run_of[r]);
    }
  }
  if (taken.empty()) return;
  condensed.how.stretches = static_cast<Index>(taken.size());
  condensed.recording = joined(taken);
  condensed.run_of = std::move(run_of);
}

}  // namespace

PlantSpeed speed_of(const ModelSpec& model) {
  PlantSpeed speed;
  for (const ChannelSpec& channel : in_channels(model).channels) {
    if (const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
        transfer != nullptr && transfer->integrating)
      continue;
    const double time = slowest_time_constant_s(channel, model.sample_time_s);
    speed.fastest_s = speed.fastest_s > 0.0 ? std::min(speed.fastest_s, time) : time;
    speed.slowest_s = std::max(speed.slowest_s, time);
  }
  return speed;
}

Index rows_to_average(const Recording& recording, Index most_rows) {
  return std::max<Index>(1, (recording.samples() + most_rows - 1) / most_rows);
}

Index rows_to_average(const Recording& recording, const PlantSpeed& speed, Index most_rows) {
  const Index all = rows_to_average(recording, most_rows);
  if (all == 1 || !(speed.fastest_s > 0.0)) return 1;
  const double dt = recording.sample_time_s;
  const auto most = static_cast<Index>(speed.fastest_s / (kRowsOfFastest * dt));
  const auto spanned = static_cast<Index>(
      std::ceil(kSlowestSpanned * speed.slowest_s / (dt * static_cast<double>(most_rows))));
  const Index wanted = std::max<Index>(1, std::min({most, spanned, all}));
  const Index held = hold_of(recording).rows;
  if (held > 1 && held <= most) return std::min((wanted + held - 1) / held, most / held) * held;
  if (held > 1) {  // a part of the interval, so that each mean is of one move
    Index every = wanted;
    while (held % every != 0) --every;
    return every;
  }
  return wanted;
}

bool is_linear(const ModelSpec& model) {
  const auto bent = [](const ChannelSpec& channel) {
    return channel.input_block || std::holds_alternative<TankChain>(channel.dynamics);
  };
  return std::none_of(model.input_blocks.begin(), model.input_blocks.end(),
                      [](const auto& block) { return block.has_value(); }) &&
         std::none_of(model.channels.begin(), model.channels.end(), bent) &&
         model.state_terms.empty();
}

bool holds_at_any_sample_time(const ModelSpec& model) {
  return !model.state_space && is_linear(model) &&
         std::all_of(model.channels.begin(), model.channels.end(), [](const ChannelSpec& channel) {
           return std::holds_alternative<TransferFunction>(channel.dynamics);
         });
}

Index rows_to_average(const Recording& recording, const ModelSpec& model, Index most_rows) {
  return holds_at_any_sample_time(model) ? rows_to_average(recording, speed_of(model), most_rows)
                                         : 1;
}

Recording averaged(const Recording& recording, double every, const std::vector<double>& offsets) {
  const std::vector<Run> runs = runs_of(recording);
  std::vector<Recording> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Recording run =
        averaged_run(part(recording, runs[r].first, runs[r].count), {offsets[r], every});
    if (run.samples() > 0) all.push_back(std::move(run));
  }
  const auto end = static_cast<double>(recording.samples());
  return all.empty() ? averaged_run(recording, {end, every}) : joined(all);
}

Condensed condensed(const Recording& recording, Index every, Index most_rows) {
  Condensed result;
  result.how.given = recording.samples();
  result.how.every = every;
  const std::vector<Run> runs = runs_of(recording);
  result.run_of.resize(runs.size());
  std::iota(result.run_of.begin(), result.run_of.end(), std::size_t{0});
  if (every > 1) {
    const Hold hold = hold_of(recording);
    std::vector<Recording> averaged;
    std::vector<std::size_t> run_of;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Index offset = hold.rows > 1 ? hold.first[r] % every : 0;
      Recording run = averaged_run(part(recording, runs[r].first, runs[r].count),
                                   {static_cast<double>(offset), static_cast<double>(every)});
      if (run.samples() < kShortestRun && runs.size() > 1) continue;
      averaged.push_back(std::move(run));
      run_of.push_back(r);
    }
    result.recording = joined(averaged);
    result.run_of = std::move(run_of);
  } else {
    result.recording = recording;
  }
  if (result.recording.samples() > most_rows) take_stretches(most_rows, result);
  return result;
}

}  // namespace mpm
