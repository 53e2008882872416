#pragma once

#include <limits>

namespace mpm {

/// One CV in the frame judged last, CV units; NaN where unknown.
struct CvReading {
  double measured = std::numeric_limits<double>::quiet_NaN();
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< measured minus predicted
};

}  // namespace mpm
