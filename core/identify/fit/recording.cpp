#include "core/identify/fit/recording.hpp"

namespace mpm {

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
  return result;
}

}  // namespace mpm
