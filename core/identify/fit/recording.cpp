#include "core/identify/fit/recording.hpp"

namespace mpm {

Recording with_setpoints(const Recording& recording) {
  Recording result = recording;
  result.aux.resize(recording.samples(), recording.aux.cols() + recording.setpoints.cols());
  result.aux << recording.aux, recording.setpoints;
  return result;
}

Recording part(const Recording& recording, Eigen::Index first, Eigen::Index count) {
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
  return result;
}

}  // namespace mpm
