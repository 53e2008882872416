#include "daemon/bag/mcap_frames.hpp"

#include <algorithm>

#include "config/finding.hpp"
#include "config/unit_layout.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/bag/contents.hpp"
#include "daemon/bag/kind_name.hpp"
#include "daemon/bag/refuse.hpp"
#include "daemon/files/aligning.hpp"
#include "idl/layout_sample.hpp"
#include "idl/topics.hpp"

namespace mpm::bag {

McapFrames::McapFrames(const std::vector<std::string>& paths, const config::UnitConfig& unit,
                       files::Purpose purpose)
    : unit_(unit),
      purpose_(purpose),
      rules_(unit, purpose),
      aligner_(
          unit.counts(), look_into(paths, purpose),
          [this](const Frame& frame) {
            last_frame_ns_ = now_ns_;
            ready_.push_back(frame);
            rules_.apply(ready_.back());
          },
          files::aligner_settings(unit)),
      samples_(paths),
      patience_ns_(files::frame_patience(unit).count()) {}

// Which kinds to wait for: as the daemon does, but what is nowhere in the file will not come.
std::array<bool, kSignalKindCount> McapFrames::look_into(const std::vector<std::string>& paths,
                                                         files::Purpose purpose) {
  std::array<bool, kSignalKindCount> wanted = files::needed_kinds(unit_);
  wanted[static_cast<std::size_t>(SignalKind::kAux)] = !unit_.aux.empty();
  if (purpose == files::Purpose::kKeep)
    for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
      wanted[kind] = unit_.counts().of(static_cast<SignalKind>(kind)) > 0;
  const Contents contents = contents_of(paths, [&](const Contents& so_far) {
    const auto found = so_far.find(unit_.unit);
    if (found == so_far.end()) return false;
    for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
      if (wanted[kind] && !found->second.kinds[kind].seen) return false;
    return true;
  });
  const std::string path = mcap::name_of(paths);
  const auto found = contents.find(unit_.unit);
  if (found == contents.end())
    refuse(path, "holds no samples of unit '" + unit_.unit + "'" +
                     (contents.empty() ? "; it holds none of any unit"
                                       : "; its units are " + names_of(contents)));
  if (purpose == files::Purpose::kJudge) check_needed(path, found->second);
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    wanted[kind] = wanted[kind] && found->second.kinds[kind].seen;
  return wanted;
}

void McapFrames::check_needed(const std::string& path, const RecordedUnit& recorded) {
  const std::array<bool, kSignalKindCount> needed = files::needed_kinds(unit_);
  const auto lacks = [&](SignalKind kind) {
    return needed[static_cast<std::size_t>(kind)] && !recorded[kind].seen;
  };
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kCv, SignalKind::kDv, SignalKind::kRaw})
    if (lacks(kind))
      refuse(path, std::string("holds no ") + topic_of(kind) + " of unit '" + unit_.unit + "'");
  if (!recorded[SignalKind::kPrediction].seen && !predictions_calculated()) {
    if (!unit_.has_model())
      refuse(path, "holds no mpm/prediction of unit '" + unit_.unit +
                       "', and its unit file has no model to simulate them");
    if (lacks(SignalKind::kPrediction))
      notices_.emplace_back(
          "no predictions in the file, so the unit file's model simulates them instead");
  }
  if (!unit_.aux.empty() && !recorded[SignalKind::kAux].seen)
    notices_.emplace_back("no aux signals in the file");
}

bool McapFrames::predictions_calculated() const {
  return std::any_of(unit_.cv.begin(), unit_.cv.end(), [this](const config::CvSignal& cv) {
    return unit_.calculation_of(cv.prediction) != nullptr;
  });
}

void McapFrames::check_layout(const mpm_Layout& layout) {
  if (layout.unit != unit_.unit) return;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    const auto kind = static_cast<SignalKind>(k);
    if (std::string_view(layout.kind) != name_of(kind)) continue;
    if (config::is_layout_of(unit_, kind, idl::texts_of(layout.tags))) continue;
    std::string notice = std::string("the recorded ") + name_of(kind) +
                         " layout has other tags, or another order, than the unit file; its order "
                         "is taken";
    if (std::find(notices_.begin(), notices_.end(), notice) == notices_.end())
      notices_.push_back(std::move(notice));
  }
}

void McapFrames::push(const idl::SampleView& sample, std::int64_t now_ns) {
  if (aligner_.pending() && now_ns - last_frame_ns_ > patience_ns_) aligner_.expire();
  now_ns_ = now_ns;
  if (!aligner_.pending()) last_frame_ns_ = now_ns;  // patience counts from here
  aligner_.push(
      {sample.kind, sample.interval, sample.source_time_ns, sample.values, sample.quality});
}

bool McapFrames::next(Frame& frame) {
  while (ready_.empty() && !done_) {
    switch (samples_.next()) {
      case SampleStream::Event::kSample:
        if (samples_.sample().unit == unit_.unit)
          push(samples_.sample(), samples_.log_time_ns());
        else
          ++of_other_units_;
        break;
      case SampleStream::Event::kLayout:
        check_layout(samples_.layout());
        break;
      case SampleStream::Event::kEnd:
        done_ = true;
        // What the daemon would still wait for at the end is of use to somebody who wants all.
        if (purpose_ == files::Purpose::kKeep)
          aligner_.finish();
        else
          aligner_.expire();
        tell_counters();
        break;
    }
  }
  if (ready_.empty()) return false;
  std::swap(frame, ready_.front());
  ready_.pop_front();
  return true;
}

void McapFrames::tell_counters() {
  const auto tell = [this](std::uint64_t count, const char* what, const std::string& rest) {
    if (count > 0) notices_.push_back(counted(count, what) + rest);
  };
  const AlignerCounters& counters = aligner_.counters();
  std::string missed;  // topics
  for (const SignalKind kind : idl::kTopicKinds)
    if (const std::uint64_t count = counters.without[static_cast<std::size_t>(kind)]; count > 0)
      missed += (missed.empty() ? ": " : ", ") + std::string(topic_of(kind)) + " of " +
                std::to_string(count);
  tell(counters.incomplete, "control interval", " of which a needed topic is missing" + missed);
  tell(counters.late, "sample", " left out that came too late for their control interval");
  tell(counters.repeated, "sample", " left out for repeating a control interval");
  tell(counters.wrong_length, "sample", " left out for a wrong number of values");
  tell(counters.beyond, "sample", " left out for an interval number beyond 2^53");
  tell(counters.infinite, "value", " taken as missing: not finite");
  tell(counters.restarts, "restart", " of the controller's count of intervals");
  if (purpose_ != files::Purpose::kKeep) return;
  tell(of_other_units_, "sample", " of other units left out");
  for (const auto& [topic, count] : samples_.others())
    notices_.push_back(counted(count, "message") + " on " + printable(topic) +
                       " left out: no signals in it");
}

}  // namespace mpm::bag
