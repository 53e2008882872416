#include "core/identify/fit/readings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/simulator.hpp"
#include "core/statistics/historian.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd columns_of(const MatrixXd& all, const std::vector<int>& cvs) {
  if (all.cols() == 0) return all;
  MatrixXd some(all.rows(), static_cast<Index>(cvs.size()));
  for (std::size_t i = 0; i < cvs.size(); ++i) some.col(static_cast<Index>(i)) = all.col(cvs[i]);
  return some;
}

/// Where each run's cycle begins that a CV is read in; nothing where it keeps to none.
std::optional<std::vector<double>> offsets_of(const Recording& recording, int cv, double every) {
  std::vector<double> offsets;
  for (const auto& [first, count] : runs_of(recording)) {
    const std::optional<double> offset =
        reading_offset(recording.cvs.col(cv).segment(first, count), every);
    if (!offset) return std::nullopt;
    offsets.push_back(*offset);
  }
  return offsets;
}

/// Rows from one reading of a CV to the next; 0: it is read at every row, or in no cycle.
double cycle_of(const Recording& recording, int cv) {
  const auto whole = static_cast<double>(reading_interval(recording.cvs.col(cv)));
  if (whole == 0.0 || offsets_of(recording, cv, whole)) return whole;
  const std::vector<Run> runs = runs_of(recording);
  const auto longest = std::max_element(
      runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.count < b.count; });
  return reading_cycle(recording.cvs.col(cv).segment(longest->first, longest->count));
}

}  // namespace

std::vector<Readings> readings_of(const Recording& recording) {
  std::vector<Readings> all = {{1.0, std::vector<double>(runs_of(recording).size(), 0.0), {}}};
  for (int cv = 0; cv < recording.cvs.cols(); ++cv) {
    const double every = std::max(1.0, cycle_of(recording, cv));
    const auto offsets = every > 1.0 ? offsets_of(recording, cv, every) : all.front().offsets;
    if (!offsets) continue;
    const auto same = std::find_if(all.begin(), all.end(), [&](const Readings& readings) {
      return readings.every == every && readings.offsets == *offsets;
    });
    if (same != all.end())
      same->cvs.push_back(cv);
    else
      all.push_back({every, *offsets, {cv}});
  }
  return all;
}

std::optional<Readings> readings_in(const Recording& other, const Readings& readings) {
  if (readings.every == 1.0)
    return Readings{1.0, std::vector<double>(runs_of(other).size(), 0.0), readings.cvs};
  Readings there{readings.every, {}, readings.cvs};
  for (const int cv : readings.cvs) {
    if (std::abs(cycle_of(other, cv) - readings.every) > kSameCycle * readings.every)
      return std::nullopt;
    auto offsets = offsets_of(other, cv, readings.every);
    if (!offsets || (!there.offsets.empty() && there.offsets != *offsets)) return std::nullopt;
    there.offsets = *std::move(offsets);
  }
  return there;
}

Recording of_cvs(const Recording& recording, const std::vector<int>& cvs) {
  Recording part = recording;
  part.cvs = columns_of(recording.cvs, cvs);
  part.setpoints = columns_of(recording.setpoints, cvs);
  return part;
}

std::optional<ModelSpec> of_readings(const ModelSpec& model, const Readings& readings) {
  if (readings.every == 1.0) return of_cvs(model, readings.cvs);
  return at_longer_sample_time(model, readings.cvs, readings.every);
}

Recording of_readings(const ModelSpec& model, const Recording& recording,
                      const Readings& readings) {
  Recording part = of_cvs(recording, readings.cvs);
  if (readings.every == 1.0) return part;
  const std::optional<ModelSpec> at_readings = of_readings(model, readings);
  if (!at_readings) return {};
  Recording result = averaged(part, readings.every, readings.offsets);
  if (result.samples() == 0) return result;
  Simulator fine(recording), coarse(result);
  for (Index i = 0; i < part.cvs.cols(); ++i)
    part.cvs.col(i) = fine.cv(model, readings.cvs[static_cast<std::size_t>(i)]);
  const MatrixXd exact = averaged(part, readings.every, readings.offsets).cvs;
  for (Index i = 0; i < part.cvs.cols(); ++i) {
    const VectorXd off = exact.col(i) - coarse.cv(*at_readings, static_cast<int>(i));
    if (off.allFinite()) result.cvs.col(i) -= off;
  }
  return result;
}

}  // namespace mpm
