#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "daemon/live/diagnosis_job.hpp"

namespace mpm::live {

/// One thread of low priority that diagnoses, one job after the other. Of each asker at most one
/// job waits, the youngest. No call but stop() ever waits for the thread: where it is just now
/// busy with its lists, the answer is "not now", and the caller comes back.
class DiagnosisWorker {
 public:
  using GoOn = std::function<bool()>;
  /// Makes one diagnosis; returns nothing if `go_on()` turned false. May throw.
  using Work = std::function<std::optional<DiagnosisOutcome>(const DiagnosisJob&, const GoOn&)>;

  explicit DiagnosisWorker(Work work);
  DiagnosisWorker(const DiagnosisWorker&) = delete;
  DiagnosisWorker& operator=(const DiagnosisWorker&) = delete;
  /// Waits for the thread if stop() did not.
  ~DiagnosisWorker();

  /// False, and `job` untouched: not now.
  [[nodiscard]] bool submit(DiagnosisJob& job);
  /// The youngest outcome for `asker`, once.
  [[nodiscard]] std::optional<DiagnosisOutcome> take(int asker);
  /// Gives up what is running and what waits. False if the thread is not through after `patience`;
  /// it is then left to itself, and the process must end without destroying what it may use.
  [[nodiscard]] bool stop(std::chrono::milliseconds patience);

 private:
  struct State;
  static void run(State& state);

  std::shared_ptr<State> state_;  // the thread holds it too
  std::thread thread_;
};

}  // namespace mpm::live
