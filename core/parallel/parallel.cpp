#include "core/parallel/parallel.hpp"

namespace mpm {
namespace {

/// Its address is another in each thread.
thread_local const char kHere = 0;

/// Thrown where pieces were not begun, for what one around them threw ends them all.
struct Ended {};

/// Counts a piece when it is left, however it is left.
struct Leaving {
  std::atomic<std::size_t>& left;
  explicit Leaving(std::atomic<std::size_t>& count) : left(count) {}
  Leaving(const Leaving&) = delete;
  Leaving& operator=(const Leaving&) = delete;
  ~Leaving() { left.fetch_add(1, std::memory_order_acq_rel); }
};

}  // namespace

Loop::Loop(const std::function<void(std::size_t)>& piece) : piece_(piece) {
  left_.store(0, std::memory_order_release);
}
Loop::~Loop() { (void)left_.load(std::memory_order_acquire); }

void Loop::run(std::size_t piece) {
  (void)left_.load(std::memory_order_acquire);
  const Leaving leaving(left_);
  piece_(piece);
  done_.fetch_add(1, std::memory_order_relaxed);
}

std::size_t Loop::done() const { return done_.load(std::memory_order_relaxed); }

Parallel::Parallel(int threads)
    : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr), home_(&kHere) {}
Parallel::~Parallel() = default;

void Parallel::for_each(std::size_t count, const std::function<void(std::size_t)>& piece) const {
  if (!arena_ || count < 2) {
    for (std::size_t i = 0; i < count; ++i) piece(i);
    return;
  }
  Loop loop(piece);
  arena_->run(count, loop);
  if (loop.done() != count) throw Ended();
}

bool Parallel::at_home() const { return home_ == &kHere; }

const Parallel& one_thread() {
  static const Parallel one(1);
  return one;
}

}  // namespace mpm
