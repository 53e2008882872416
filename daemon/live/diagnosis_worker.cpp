#include "daemon/live/diagnosis_worker.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "daemon/host/low_priority.hpp"
#include "daemon/host/memory.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::live {

struct DiagnosisWorker::State {
  Work work;
  std::atomic<bool> stopped = false;
  Mutex mutex;
  ConditionVariable changed;
  std::deque<DiagnosisJob> waiting MPM_GUARDED_BY(mutex);
  std::vector<DiagnosisOutcome> outcomes
      MPM_GUARDED_BY(mutex);  // at most one of each kind per asker
  bool ended MPM_GUARDED_BY(mutex) = false;
};

DiagnosisWorker::DiagnosisWorker(Work work) : state_(std::make_shared<State>()) {
  state_->work = std::move(work);
  thread_ = std::thread([state = state_] { run(*state); });
}

DiagnosisWorker::~DiagnosisWorker() {
  if (!thread_.joinable()) return;
  state_->stopped = true;
  { const MutexLock lock(state_->mutex); }  // the thread waits or will look
  state_->changed.notify_all();
  thread_.join();
}

bool DiagnosisWorker::submit(DiagnosisJob& job) {
  {
    if (!state_->mutex.try_lock()) return false;
    const MutexLock lock(state_->mutex, std::adopt_lock);
    auto& waiting = state_->waiting;
    const auto same = std::find_if(waiting.begin(), waiting.end(), [&](const DiagnosisJob& other) {
      return other.asker == job.asker;
    });
    if (same == waiting.end())
      waiting.push_back(std::move(job));
    else if (!job.only_writes)  // one that waits will write, too
      *same = std::move(job);
  }
  state_->changed.notify_all();
  return true;
}

std::optional<DiagnosisOutcome> DiagnosisWorker::take(int asker) {
  if (!state_->mutex.try_lock()) return std::nullopt;
  const MutexLock lock(state_->mutex, std::adopt_lock);
  auto& outcomes = state_->outcomes;
  const auto own =
      std::find_if(outcomes.begin(), outcomes.end(),
                   [asker](const DiagnosisOutcome& outcome) { return outcome.asker == asker; });
  if (own == outcomes.end()) return std::nullopt;
  std::optional<DiagnosisOutcome> outcome = std::move(*own);
  outcomes.erase(own);
  return outcome;
}

bool DiagnosisWorker::stop(std::chrono::milliseconds patience) {
  if (!thread_.joinable()) return true;
  state_->stopped = true;
  bool ended = false;
  {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    MutexLock lock(state_->mutex);
    state_->changed.notify_all();
    while (!state_->ended && state_->changed.wait_until(lock, deadline)) {
    }
    ended = state_->ended;
  }
  if (ended)
    thread_.join();
  else
    thread_.detach();
  return ended;
}

void DiagnosisWorker::run(State& state) {
  host::take_low_priority("mpm-diagnosis");
  const GoOn go_on = [&state] { return !state.stopped; };
  MutexLock lock(state.mutex);
  while (true) {
    while (!state.stopped && state.waiting.empty()) state.changed.wait(lock);
    if (state.stopped) break;
    const DiagnosisJob job = std::move(state.waiting.front());
    state.waiting.pop_front();
    lock.unlock();
    std::optional<DiagnosisOutcome> outcome;
    try {
      outcome = state.work(job, go_on);
    } catch (const std::exception& error) {
      outcome.emplace();
      outcome->problem = error.what();
    }
    host::give_memory_back();
    if (outcome) {
      outcome->asker = job.asker;
      outcome->only_wrote = job.only_writes;
      outcome->alarm_time_ns = job.alarm_time_ns;
      outcome->interval = job.samples.last_interval;
      outcome->time_ns = job.samples.last_time_ns;
    }
    lock.lock();
    if (!outcome) continue;
    auto& outcomes = state.outcomes;
    outcomes.erase(std::remove_if(outcomes.begin(), outcomes.end(),
                                  [&](const DiagnosisOutcome& older) {
                                    return older.asker == job.asker &&
                                           older.only_wrote == job.only_writes;
                                  }),
                   outcomes.end());
    outcomes.push_back(std::move(*outcome));
  }
  state.ended = true;
  state.changed.notify_all();
}

}  // namespace mpm::live
