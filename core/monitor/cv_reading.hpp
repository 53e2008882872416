#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace mpm {

/// One CV in a frame that was judged, CV units; NaN where unknown.
struct CvReading {
  double measured = std::numeric_limits<double>::quiet_NaN();
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< measured minus predicted
  /// Read before it was known what its signals usually are: it may be wild.
  bool early = false;

  template <class Archive>
  void archive(Archive& a) {
    a(measured, residual, early);
  }
};

/// A frame as the monitor judged it.
struct JudgedFrame {
  std::int64_t interval = 0;
  std::vector<CvReading> readings;  ///< per CV

  template <class Archive>
  void archive(Archive& a) {
    a(interval, readings);
  }
};

}  // namespace mpm
