#include "daemon/files/shifted_cvs.hpp"

#include <algorithm>
#include <utility>

namespace mpm::files {

bool ShiftedCvs::next(Frame& frame) {
  if (!std::exchange(begun_, true) && !source_.next(before_)) return false;
  Frame now = before_;
  if (!source_.next(now)) return false;
  const bool follows = now.interval == before_.interval + 1;
  const bool earlier = way_ == Way::kEarlier;
  frame = earlier ? before_ : now;
  SignalBlock& cvs = frame[SignalKind::kCv];
  cvs = (earlier ? now : before_)[SignalKind::kCv];
  if (!follows) std::fill(cvs.quality.begin(), cvs.quality.end(), Quality::kBad);
  before_ = std::move(now);
  return true;
}

}  // namespace mpm::files
