#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mismatch/verdict.hpp"
#include "core/model/model_spec.hpp"
#include "core/monitor/monitor.hpp"
#include "core/monitor/settings.hpp"
#include "core/monitor/unit_reader.hpp"
#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"
#include "core/statistics/reading_cycle.hpp"

namespace mpm {

class Archive;

/// CVs that are read only every so many samples (an analyser's). What stands between two readings
/// is no measurement, so each is judged at its readings, by a monitor of that CV alone at a sample
/// time as long as its cycle: it takes the measured reading, the prediction of that moment, and as
/// inputs their means until the next reading. One reading behind: what acted until then belongs to
/// it. Allocates where a CV turns out to be read so.
class SeldomCvs {
 public:
  /// `lags`: at which a channel is looked at, samples. `settings` and `alarms` as of the unit.
  SeldomCvs(const ModelSpec& model, const SignalCounts& counts, int lags,
            const MonitorSettings& settings, const AlarmSettings& alarms);

  /// Takes the CVs' values as they come, before a screen marks what stands.
  void see(const Frame& frame);
  /// Takes the frame when it has left the screen and is read.
  void take(const Frame& frame, const UnitReader& reader);
  /// What was learnt of the CV says nothing of what follows.
  void begin_anew(int cv);

  /// CVs that with the last frame have begun to be judged so, in another cycle, or no longer.
  [[nodiscard]] const std::vector<int>& turned() const { return turned_; }
  /// Of a CV that is judged so; null of others.
  [[nodiscard]] const Monitor* monitor(int cv) const {
    const std::optional<Part>& part = parts_[static_cast<std::size_t>(cv)];
    return part ? &part->monitor : nullptr;
  }
  /// It is, its last reading is no older than it may be, and its readings serve.
  [[nodiscard]] bool stands(int cv) const;
  /// It is, and a reading has come to judge with the last frame.
  [[nodiscard]] bool judged(int cv) const {
    const std::optional<Part>& part = parts_[static_cast<std::size_t>(cv)];
    return part && part->judged;
  }
  /// Of a CV that is judged so, in samples of the unit, signals counted as the unit's are; the
  /// reported correlation is not among it.
  void read(int cv, int input, ChannelStatus& status) const;
  [[nodiscard]] double samples_needed(int cv) const;
  [[nodiscard]] double cycle(int cv) const { return part(cv).cycle; }
  /// `Monitor::stand`.
  void stand(int cv, int input) { part(cv).monitor.stand(0, input); }

  void archive(Archive& a);

 private:
  struct Seen {
    std::int64_t interval = 0;
    Eigen::VectorXd values;  // of the CVs, NaN where unknown
    void archive(Archive& a);
  };
  struct Part {
    Part(Monitor of_cv, double samples, const SignalCounts& counts);
    Monitor monitor;
    double cycle;   // samples
    Frame pending;  // the last reading, until it is known what acted after it
    bool is_pending = false;
    bool judged = false;       // with the last frame
    bool lost = false;         // its readings do not serve (`LostSignals`)
    Eigen::VectorXd sums;      // of the inputs since, MVs first
    Eigen::VectorXd summands;  // how many
    void add(const Frame& frame);
    void push();
    void archive(Archive& a);
  };
  [[nodiscard]] Part& part(int cv) { return *parts_[static_cast<std::size_t>(cv)]; }
  [[nodiscard]] const Part& part(int cv) const { return *parts_[static_cast<std::size_t>(cv)]; }
  [[nodiscard]] std::optional<Part> make(int cv, double cycle) const;
  [[nodiscard]] int lags_at(double cycle) const;
  void follow_cycle(int cv);
  void begin_reading(int cv, const ReadingCycle::Reading& reading, const Frame& frame,
                     const UnitReader& reader);

  ModelSpec model_;
  SignalCounts counts_;
  int lags_;
  MonitorSettings settings_;
  AlarmSettings alarms_;
  std::vector<Seen> seen_;  // of frames that wait in the screen, a ring
  std::size_t next_ = 0;
  std::int64_t interval_ = 0;         // of the last frame that was taken
  std::vector<ReadingCycle> cycles_;  // per CV
  std::vector<double> tried_;         // the cycle for which there is a part, or can be none; per CV
  std::vector<std::optional<Part>> parts_;
  std::vector<int> turned_;
};

}  // namespace mpm
