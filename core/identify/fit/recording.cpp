#include "core/identify/fit/recording.hpp"

namespace mpm {

using Eigen::Index;

std::vector<Run> runs_of(const Recording& recording) {
  std::vector<Run> runs = {{0, recording.samples()}};
  for (const Border& border : recording.borders) {
    runs.back().count = border.row - runs.back().first;
    runs.push_back({border.row, recording.samples() - border.row});
  }
  return runs;
}

double on_clock(const Recording& recording, double time_s) {
  // A moment between the last row of a run and the first of the next belongs to the former.
  const double rows = (time_s - recording.start_s) / recording.sample_time_s;
  double ahead_s = 0.0;
  for (const Border& border : recording.borders)
    if (rows > static_cast<double>(border.row) - 0.5) ahead_s = border.ahead_s;
  return time_s + ahead_s;
}

Recording with_setpoints(const Recording& recording) {
  Recording result = recording;
  result.aux.resize(recording.samples(), recording.aux.cols() + recording.setpoints.cols());
  result.aux << recording.aux, recording.setpoints;
  return result;
}

Recording part(const Recording& recording, Index first, Index count) {
  Recording result;
  result.sample_time_s = recording.sample_time_s;
  result.start_s = recording.start_s + static_cast<double>(first) * recording.sample_time_s;
  result.inputs = recording.inputs.middleRows(first, count);
  result.cvs = recording.cvs.middleRows(first, count);
  if (recording.aux.cols() > 0)
    result.aux = recording.aux.middleRows(first, count);
  else
    result.aux.resize(count, 0);
  if (recording.setpoints.cols() > 0)
    result.setpoints = recording.setpoints.middleRows(first, count);
  double ahead_s = 0.0;  // of the part's first row
  for (const Border& border : recording.borders) {
    if (border.row <= first)
      ahead_s = border.ahead_s;
    else if (border.row < first + count)
      result.borders.push_back({border.row - first, border.ahead_s - ahead_s});
  }
  result.start_s += ahead_s;
  if (recording.changed && *recording.changed > first && *recording.changed < first + count)
    result.changed = *recording.changed - first;
  result.noise_before = recording.noise_before;
  result.sticking = recording.sticking;
  return result;
}

Recording joined(const std::vector<Recording>& recordings) {
  Recording result = recordings.front();
  for (std::size_t i = 1; i < recordings.size(); ++i) {
    const Recording& next = recordings[i];
    const Index first = result.samples(), samples = first + next.samples();
    const double by_rows = result.start_s + static_cast<double>(first) * result.sample_time_s;
    const double ahead_s = next.start_s - by_rows;
    result.borders.push_back({first, ahead_s});
    for (const Border& border : next.borders)
      result.borders.push_back({first + border.row, ahead_s + border.ahead_s});
    const auto append = [&](Eigen::MatrixXd& block, const Eigen::MatrixXd& more) {
      block.conservativeResize(samples, Eigen::NoChange);
      block.bottomRows(more.rows()) = more;
    };
    append(result.inputs, next.inputs);
    append(result.cvs, next.cvs);
    append(result.aux, next.aux);
    if (result.setpoints.cols() == next.setpoints.cols()) append(result.setpoints, next.setpoints);
  }
  return result;
}

}  // namespace mpm
