#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/alarm/condition.hpp"
#include "core/mismatch/verdict.hpp"
#include "core/model/model_spec.hpp"
#include "core/monitor/cv_reading.hpp"
#include "core/monitor/lost_signals.hpp"
#include "core/monitor/settings.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"
#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

class Archive;

/// A change of one channel's alarm, caused by the frame just pushed.
struct AlarmTransition {
  int cv = 0;
  int input = 0;
  AlarmState to = AlarmState::kCleared;
  AlarmEvidence before;  ///< as of the sample before: what a CV that begins anew has forgotten

  template <class Archive>
  void archive(Archive& a) {
    a(cv, input, before);
    a.within(to, AlarmState::kCleared, AlarmState::kActive);
  }
};

/// What the monitor did with the frames so far.
struct MonitorCounters {
  std::uint64_t frames = 0;        ///< pushed
  std::uint64_t used = 0;          ///< gave some CV a row
  std::uint64_t missing = 0;       ///< intervals skipped between frames
  std::uint64_t out_of_order = 0;  ///< frames not newer than the last one; ignored
  std::uint64_t bad_values = 0;    ///< non-finite or bad values of signals that are needed, in the
                                   ///< frames that have left the screen
  ScreenCounters implausible;      ///< of these: good by their quality, but not by their look
  /// Whose they are: per kind and signal, empty where the kind is not needed.
  std::array<std::vector<std::uint64_t>, kSignalKindCount> bad_of;

  template <class Archive>
  void archive(Archive& a) {
    a(frames, used, missing, out_of_order, bad_values, implausible, bad_of);
  }
};

/// The whole pipeline as one object: frame -> residual -> recursive statistics -> verdict -> alarm.
/// Deterministic: same frames, same bytes. No allocation in `push` after construction, but where a
/// signal turns out to live elsewhere than it did (`Screen::anew`) and all is begun anew, where the
/// nonlinear test of a CV begins (`NonlinearRegression`), where one turns out to be read only every
/// so many samples (`SeldomCvs`), and where something is off and is asked,
/// each 20 samples at most, whether the plant bends (`Curvature`).
class Monitor {
 public:
  /// Whether CVs are looked at for a cycle in which they are read (`SeldomCvs`).
  enum class Cycles { kAny, kNone };

  /// `may_predict[j]`: CV j's model prediction may come with the frames. Where none does
  /// (`Screen::predicted`), it is simulated from `model`; each time that this changes the CV begins
  /// anew.
  Monitor(const ModelSpec& model, const SignalCounts& counts, const std::vector<bool>& may_predict,
          const MonitorSettings& settings, const AlarmSettings& alarms,
          Cycles cycles = Cycles::kAny);
  Monitor(Monitor&&) noexcept;
  Monitor& operator=(Monitor&&) noexcept;
  ~Monitor();

  /// Takes the frame of the next interval; frames come in increasing interval order, a jump is a
  /// gap, of which nothing is known. What is said after it rests on frames up to `Screen::kDelay`
  /// before it, or `Screen::kLongestDelay` where a signal may be on an excursion; several are then
  /// judged at once.
  void push(const Frame& frame);

  /// An alarm that another monitor of the unit raised: it stands until this one's own evidence
  /// clears it.
  void stand(int cv, int input);

  /// Brings the reported correlations up to the last frame. Not done by `push`: rows that wait for
  /// each other cost a fraction.
  void correlate();

  /// After the last frame; `partial_correlation` and `lag` as of the last `correlate`.
  [[nodiscard]] const ChannelStatus& channel(int cv, int input) const;
  [[nodiscard]] AlarmState alarm(int cv, int input) const;
  /// What the nonlinear test says of a channel, as of its CV's last evaluation; undetermined where
  /// no verdict could be drawn of the data, or the test is off.
  [[nodiscard]] const ChannelNonlinearity& nonlinearity(int cv, int input) const;
  /// Correlations of a channel, of the kind that the settings name ((3.15) if none), for lags
  /// first_lag()..last_lag(), as of the last `correlate`. Undefined ones (silent or collinear
  /// input) are 0.
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> partial_correlations(int cv, int input) const;
  [[nodiscard]] int first_lag() const;
  [[nodiscard]] int last_lag() const;
  /// The frames that the last `push` judged, oldest first, `Screen::kDelay` or more before the one
  /// that it took. Valid until the next one.
  [[nodiscard]] std::span<const JudgedFrame> judged() const;
  /// Changes caused by the last `push`; valid until the next one.
  [[nodiscard]] const std::vector<AlarmTransition>& transitions() const;
  [[nodiscard]] const MonitorCounters& counters() const;
  /// Signals that verdicts need and that have had no usable value for long, as of the frames that
  /// have left the screen.
  [[nodiscard]] std::vector<LostSignal> lost() const;
  /// Predictions of the CV came with the frames, and do no longer: they are simulated.
  [[nodiscard]] bool replaced(int cv) const;
  /// The predictions of the CV that come are corrected by its measurement: they are simulated.
  [[nodiscard]] bool corrected(int cv) const;
  /// The predictions of the CV that come, and are used, are not what the model gives.
  [[nodiscard]] bool of_other_model(int cv) const;
  /// Of a CV that is judged at its readings: samples from one to the next; 0 of others.
  [[nodiscard]] double read_every(int cv) const;
  /// How many more samples the CV's verdicts need at least, if all of them serve; 0 = none.
  [[nodiscard]] double samples_needed(int cv) const;

  /// All that the samples have changed.
  void archive(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mpm
