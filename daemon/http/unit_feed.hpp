#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "daemon/history/digest_maker.hpp"
#include "daemon/http/unit_snapshot.hpp"
#include "daemon/live/unit_observer.hpp"

namespace mpm::http {

/// What came of a unit since somebody last looked. Values lie flat, so that a sample allocates
/// nothing once the vectors have grown.
struct Delivery {
  struct Row {
    std::int64_t interval = 0, time_ns = 0;
    std::size_t judged = 0;  ///< of the judgements, those that were there with this frame
  };
  std::vector<Row> rows;             ///< frames
  std::vector<float> values;         ///< of each: see FeedColumns
  std::vector<std::int64_t> judged;  ///< intervals, later than they came
  std::vector<float> readings;  ///< of each CV: prediction, residual, 1 while it is known to match
  std::vector<history::Digest> digests;
  std::vector<std::pair<AlarmRecord, std::string>> alarms;  ///< changes, in words
  std::optional<live::DiagnosisOutcome> diagnosis;
  std::shared_ptr<UnitSnapshot> view;  ///< the last one; null: none since
  std::uint64_t dropped = 0;           ///< frames that nobody fetched in time

  void clear();
};

/// Where a frame's values stand in a row: measured, prediction and set-point of each CV, then the
/// inputs. NaN where a value is not usable.
struct FeedColumns {
  int cvs = 0, inputs = 0;

  [[nodiscard]] int width() const { return 3 * cvs + inputs; }
  [[nodiscard]] int measured(int cv) const { return 3 * cv; }
  [[nodiscard]] int prediction(int cv) const { return 3 * cv + 1; }
  [[nodiscard]] int setpoint(int cv) const { return 3 * cv + 2; }
  [[nodiscard]] int input(int index) const { return 3 * cvs + index; }
};
inline constexpr int kReadingWidth = 3;

/// The event loop's side: notes what a unit does, and never waits for anybody. What it has noted is
/// its own until it can hand it over without waiting.
class UnitFeed : public live::UnitObserver {
 public:
  /// Between two views, while frames come and while none do. An eye takes no more.
  static constexpr std::chrono::milliseconds kViewPeriod{500}, kIdlePeriod{2000};
  /// Frames that may lie about: some minutes of a unit at a hundred times its speed. Recalled ones
  /// are as many as are kept, and come before anything waits for the loop.
  static constexpr std::size_t kMostRows = 20'000;

  explicit UnitFeed(const config::UnitConfig& unit);

  void on_frame(const Frame& frame, const report::UnitMonitor& monitor) override;
  void on_recalled(const Frame& frame, const report::UnitMonitor* monitor) override;
  void on_alarm(const AlarmRecord& alarm, const std::string& text) override;
  void on_diagnosis(const live::DiagnosisOutcome& outcome) override;
  [[nodiscard]] bool wants_view(Clock::time_point now) override;
  void on_view(const live::UnitView& view) override;

  /// In the loop: hands over what has been noted, where all before has been fetched and nobody is
  /// at it just now. Done after each frame and whenever a view might be wanted.
  void offer();
  /// From any thread: takes what was handed over, if anything, and leaves `emptied` in its place.
  void fetch(Delivery& emptied);

 private:
  void note_digest(const report::UnitMonitor& monitor);
  void note_frame(const Frame& frame);
  void note_readings(const Monitor& monitor);

  FeedColumns columns_;
  SignalCounts counts_;
  history::DigestMaker digests_;
  Clock::time_point last_view_{};
  bool news_ = true;  // since the last view
  Delivery noted_;
  Mutex mutex_;
  Delivery offered_ MPM_GUARDED_BY(mutex_);
  bool fetched_ MPM_GUARDED_BY(mutex_) = true;  // nothing is offered
};

}  // namespace mpm::http
