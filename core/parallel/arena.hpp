#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace mpm {

/// One loop over pieces, as the threads that take part see it. oneTBB sees to it that a piece finds
/// what was written before the loop, and that what it wrote is there behind the loop; a thread
/// sanitizer, for which oneTBB is not built, is told so here.
class Loop {
 public:
  /// `piece` must outlive it.
  explicit Loop(const std::function<void(std::size_t)>& piece);
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  /// Behind the loop, however it ended.
  ~Loop();

  void run(std::size_t piece);
  /// How many pieces came to their end.
  [[nodiscard]] std::size_t done() const;

 private:
  const std::function<void(std::size_t)>& piece_;
  std::atomic<std::size_t> done_{0};
  std::atomic<std::size_t> left_{0};  ///< pieces, whether they came to their end or threw
};

/// Threads that pieces are given to: oneTBB's, which no other file than arena.cpp names.
class Arena {
 public:
  /// The caller's thread is one of `threads`.
  explicit Arena(int threads);
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  ~Arena();

  /// loop.run(0) .. loop.run(count - 1). What one throws is thrown here once none runs any more;
  /// then, and where a loop around this one ends so, some may never have been run.
  void run(std::size_t count, Loop& loop);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

/// Threads that the machine grants this process.
[[nodiscard]] int available_threads();

}  // namespace mpm
