#include "core/parallel/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace mpm {
namespace {

/// Its address is another in each thread.
thread_local const char here = 0;

/// Thrown where pieces were not begun, for what one around them threw ends them all.
struct Ended {};

}  // namespace

struct Parallel::Arena {
  explicit Arena(int threads)
      : allowed(oneapi::tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(std::max(threads, available_threads()))),
        tasks(threads) {}
  oneapi::tbb::global_control allowed;  ///< else no more threads than cores
  oneapi::tbb::task_arena tasks;
};

Parallel::Parallel(int threads)
    : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr), home_(&here) {}
Parallel::~Parallel() = default;

void Parallel::for_each(std::size_t count, const std::function<void(std::size_t)>& piece) const {
  if (!arena_ || count < 2) {
    for (std::size_t i = 0; i < count; ++i) piece(i);
    return;
  }
  std::atomic<std::size_t> done{0};
  arena_->tasks.execute([&] {
    oneapi::tbb::parallel_for(
        std::size_t{0}, count,
        [&](std::size_t i) {
          piece(i);
          done.fetch_add(1, std::memory_order_relaxed);
        },
        oneapi::tbb::simple_partitioner());
  });
  if (done.load(std::memory_order_relaxed) != count) throw Ended();
}

bool Parallel::at_home() const { return home_ == &here; }

const Parallel& one_thread() {
  static const Parallel one(1);
  return one;
}

int available_threads() { return oneapi::tbb::info::default_concurrency(); }

}  // namespace mpm
