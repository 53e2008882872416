#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/parallel/arena.hpp"

namespace mpm {

/// Work in pieces that do not need each other, on several threads. Each piece has a place of its
/// own to write to, and whoever needs all of them looks at them in their order: so what comes of it
/// does not depend on the number of threads.
class Parallel {
 public:
  /// `threads` >= 1, that of the caller among them; with one nothing is started.
  explicit Parallel(int threads);
  Parallel(const Parallel&) = delete;
  Parallel& operator=(const Parallel&) = delete;
  ~Parallel();

  /// piece(0) .. piece(count - 1), each once; a piece may do the same. What a piece throws ends the
  /// others as soon as they are done with what they are at, and is thrown here.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& piece) const;

  /// Whether this is the thread that made it. It has its share of all work.
  [[nodiscard]] bool at_home() const;

 private:
  std::unique_ptr<Arena> arena_;  ///< none: one thread
  const void* home_;
};

/// Work where nobody asks for more.
[[nodiscard]] const Parallel& one_thread();

}  // namespace mpm
