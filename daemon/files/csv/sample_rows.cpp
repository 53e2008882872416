#include "daemon/files/csv/sample_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/files/csv/cell.hpp"

namespace mpm::files {
namespace {

// Tags that are sampled together lack a row now and then.
constexpr double kSharedTimes = 0.75;

/// For each tag `value`.
template <class Value>
void fill(std::array<std::vector<Value>, kSignalKindCount>& tags, const SignalCounts& counts,
          Value value) {
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    tags[kind].assign(static_cast<std::size_t>(counts.of(static_cast<SignalKind>(kind))), value);
}

}  // namespace

TagTimes::TagTimes(const SignalCounts& counts, std::int64_t within_ns) : within_ns_(within_ns) {
  fill(tags_, counts, Tag());
}

void TagTimes::add(const Slot& slot, std::int64_t time_ns) {
  Tag& tag = tags_[static_cast<std::size_t>(slot.kind)][static_cast<std::size_t>(slot.index)];
  const bool again = tag.last == count_ && time_ns != begin_ns_;
  if (count_ == 0 || time_ns - begin_ns_ > within_ns_ || again) {
    ++count_;
    begin_ns_ = time_ns;
  }
  if (tag.count == 0) tag.first = count_;
  if (tag.last == count_) return;
  tag.last = count_;
  ++tag.count;
}

bool TagTimes::apart() const {
  for (const std::vector<Tag>& kind : tags_)
    for (const Tag& tag : kind)
      if (tag.count > 0 && static_cast<double>(tag.count) <
                               kSharedTimes * static_cast<double>(count_ - tag.first + 1))
        return true;
  return false;
}

bool SampleRows::next(Frame& frame) {
  if (!pending_) pending_ = next_sample();
  if (!pending_) {
    tell();
    return false;
  }
  clear(frame, counts_);
  fill(told_, counts_, false);
  fill(next_, counts_, kNoSample);
  frame.source_time_ns = pending_->time_ns;
  const std::int64_t within_ns =
      tag_times_.apart() && !near_times_.apart() ? format_.together_ns : 0;
  while (pending_ &&
         (pending_->time_ns == frame.source_time_ns ||
          (pending_->time_ns - frame.source_time_ns <= within_ns && !told(pending_->slot)))) {
    put(*pending_, frame);
    pending_ = next_sample();
  }
  return true;
}

void SampleRows::gather() {
  std::vector<Sample> all;
  while (const std::optional<Sample> sample = read_sample()) all.push_back(*sample);
  std::stable_sort(all.begin(), all.end(),
                   [](const Sample& a, const Sample& b) { return a.time_ns < b.time_ns; });
  std::array<std::vector<std::size_t>, kSignalKindCount> next;
  fill(next, counts_, kNoSample);
  for (std::size_t i = all.size(); i-- > 0;) {
    const Slot& slot = all[i].slot;
    std::size_t& of_tag =
        next[static_cast<std::size_t>(slot.kind)][static_cast<std::size_t>(slot.index)];
    all[i].next = of_tag;
    of_tag = i;
  }
  tag_times_ = TagTimes(counts_);
  near_times_ = TagTimes(counts_, format_.together_ns);
  for (const Sample& sample : all) note_time(sample.slot, sample.time_ns);
  gathered_ = std::move(all);
}

void SampleRows::note_time(const Slot& slot, std::int64_t time_ns) {
  tag_times_.add(slot, time_ns);
  near_times_.add(slot, time_ns);
}

bool SampleRows::told(const Slot& slot) const {
  return told_[static_cast<std::size_t>(slot.kind)][static_cast<std::size_t>(slot.index)];
}

const Sample* SampleRows::following(SignalKind kind, std::size_t index) const {
  const std::size_t next = next_[static_cast<std::size_t>(kind)][index];
  return next == kNoSample || !gathered_ ? nullptr : &(*gathered_)[next];
}

Sample SampleRows::sample_of(std::string_view tag, const Slot& slot, const TimeColumns& time,
                             const Cell& value, const std::vector<QualityColumn>& qualities) {
  Sample sample;
  sample.slot = slot;
  sample.time_ns = read_time(lines_, cells_, time, times_, tag);
  sample.value = read_value(lines_, format_, value, tally_);
  sample.quality = Quality::kGood;
  for (const QualityColumn& column : qualities)
    sample.quality = std::max(sample.quality,
                              read_quality(lines_, format_, column, cells_[column.cell], tally_));
  if (!std::isfinite(sample.value)) sample.quality = Quality::kBad;
  return sample;
}

void SampleRows::tell() {
  tally_.tell(notices_);
  tally_ = {};
  for (std::string& notice : times_.notices()) notices_.push_back(std::move(notice));
  times_.restart();
}

std::optional<Sample> SampleRows::next_sample() {
  if (!gathered_) return read_sample();
  return at_ < gathered_->size() ? std::optional((*gathered_)[at_++]) : std::nullopt;
}

void SampleRows::put(const Sample& sample, Frame& frame) {
  const auto at = static_cast<std::size_t>(sample.slot.index);
  std::vector<bool>& told = told_[static_cast<std::size_t>(sample.slot.kind)];
  if (told[at]) ++tally_.repeated;
  told[at] = true;
  next_[static_cast<std::size_t>(sample.slot.kind)][at] = sample.next;
  SignalBlock& block = frame[sample.slot.kind];
  block.values(sample.slot.index) = sample.value;
  block.quality[at] = sample.quality;
}

}  // namespace mpm::files
