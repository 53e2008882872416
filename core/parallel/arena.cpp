#include "core/parallel/arena.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

namespace mpm {

namespace tbb = oneapi::tbb;

struct Arena::Threads {
  explicit Threads(int threads)
      : allowed(tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(std::max(threads, available_threads()))),
        arena(threads) {}
  tbb::global_control allowed;  ///< else no more threads than cores
  tbb::task_arena arena;
};

Arena::Arena(int threads) : threads_(std::make_unique<Threads>(threads)) {}
Arena::~Arena() = default;

void Arena::run(std::size_t count, Loop& loop) {
  threads_->arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, count, [&](std::size_t i) { loop.run(i); }, tbb::simple_partitioner());
  });
}

int available_threads() { return tbb::info::default_concurrency(); }

}  // namespace mpm
