#pragma once

#include <atomic>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "daemon/bag/record/recording_writer.hpp"
#include "daemon/host/clock.hpp"
#include "idl/discovery.hpp"
#include "idl/raw_reader.hpp"
#include "idl/unit_choice.hpp"
#include "idl/wait_set.hpp"

namespace mpm::bag {

struct RecorderOptions {
  RecordingOptions recording;
  std::vector<std::string> topics;  ///< empty = all of ours
  std::string unit;                 ///< only this one's samples; empty = all
  std::size_t queue_bytes = std::size_t{64} << 20U;
};

struct RecorderState {
  RecordingTotals totals;
  std::uint64_t dropped = 0;  ///< taken but not in the file: the disk did not follow, or is full
  std::uint64_t lost = 0;     ///< DDS says so
  std::uint64_t refused = 0;  ///< of instances too many, or with names too long
  std::string path;           ///< of the open file
  std::string problem;        ///< why the disk takes nothing any more; empty = it does
};

/// Takes samples in the caller's thread and writes them in one of its own, so that a slow disk
/// never slows down the process that is recorded.
class Recorder {
 public:
  /// Throws as RecordingWriter does.
  Recorder(const idl::Participant& participant, const RecorderOptions& options);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();

  /// Waits for samples at most `longest` and takes what is there.
  void poll(std::chrono::milliseconds longest);
  /// Looks for chosen topics whose type only their writers know, and for what was refused. About
  /// once a second is enough.
  void look_around();
  /// Saves a snapshot of all that was taken so far.
  void save() { save_asked_ = true; }
  /// Takes what is there, writes all and closes the file.
  void finish();

  [[nodiscard]] RecorderState state() const;
  /// What there is to tell, in whole sentences, since the last call.
  [[nodiscard]] std::vector<std::string> take_news();
  /// Chosen topics that nobody writes yet, or not with a type that could be asked for.
  [[nodiscard]] const std::set<std::string>& not_found() const { return not_found_; }

 private:
  void add_known(const idl::KnownTopic& topic);
  void add_reader(idl::RawReader reader, const RecordedTopic& description);
  void look_for_topics();
  void look_for_refused();
  /// Returns how many samples there were.
  int take();
  void write_all();

  const idl::Participant& participant_;
  idl::Discovery discovery_;
  std::string unit_;
  idl::UnitChoice chosen_;  // that one alone
  std::set<std::string> not_found_;
  std::uint64_t refused_ = 0;
  std::size_t large_bytes_ = 0;       // of large samples since the last look around
  int trims_ = 0;                     // so many looks around will give memory back
  std::set<std::string> refused_on_;  // topics, told once
  std::vector<std::string> news_;
  host::ArrivalClock clock_;  // log times are its

  // Of the thread that takes; topic i of the recording is read by reader i.
  std::vector<idl::RawReader> readers_;
  idl::WaitSet wait_set_;
  std::vector<RecordedSample> batch_;

  SampleQueue queue_;
  std::atomic<bool> save_asked_ = false;
  mutable Mutex mutex_;
  RecordingWriter recording_ MPM_GUARDED_BY(mutex_);
  std::string problem_ MPM_GUARDED_BY(mutex_);
  // Samples that came too late for the file after a problem.
  std::uint64_t unwritten_ MPM_GUARDED_BY(mutex_) = 0;
  std::thread writer_;
};

}  // namespace mpm::bag
