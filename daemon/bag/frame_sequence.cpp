#include "daemon/bag/frame_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "daemon/bag/open_recording.hpp"

namespace mpm::bag {

FrameSequence::FrameSequence(const std::vector<std::string>& paths, const config::UnitConfig& unit,
                             const files::TimeStyle& times)
    : unit_(unit), times_(times) {
  std::vector<std::pair<std::int64_t, std::string>> found;
  Frame frame(unit.counts());
  for (const std::string& path : paths)
    if (open_recording(path, unit, times)->next(frame))
      found.emplace_back(frame.source_time_ns, path);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [time_ns, path] : found) paths_.push_back(std::move(path));
}

bool FrameSequence::next(Frame& frame) {
  while (open_ || next_ < paths_.size()) {
    if (!open_) open_next();
    if (!open_->next(frame)) {
      close();
      continue;
    }
    if (!shift_ && any_ && frame.source_time_ns <= last_ns_) {
      ++overlapping_;
      continue;
    }
    if (!shift_) {
      const double apart = static_cast<double>(frame.source_time_ns - last_ns_) /
                           (unit_.sample_time_s * kNsPerSecond);
      const std::int64_t first =
          any_ ? last_interval_ + std::max<std::int64_t>(1, std::llround(apart)) : frame.interval;
      shift_ = first - frame.interval;
    }
    frame.interval += *shift_;
    any_ = true;
    last_interval_ = std::max(last_interval_, frame.interval);
    last_ns_ = std::max(last_ns_, frame.source_time_ns);
    return true;
  }
  return false;
}

double FrameSequence::share_read() const {
  const double whole = static_cast<double>(next_) - (open_ ? 1.0 - open_->share_read() : 0.0);
  return paths_.empty() ? 1.0 : whole / static_cast<double>(paths_.size());
}

void FrameSequence::open_next() {
  open_ = open_recording(paths_[next_++], unit_, times_);
  shift_.reset();
  overlapping_ = 0;
}

void FrameSequence::close() {
  const std::string prefix = paths_[next_ - 1] + ": ";
  for (const std::string& notice : open_->notices())
    notices_.push_back(notice.starts_with(prefix) ? notice : prefix + notice);
  if (overlapping_ > 0)
    notices_.push_back(prefix + counted(overlapping_, "row") +
                       " left out that other files hold already");
  open_.reset();
}

}  // namespace mpm::bag
