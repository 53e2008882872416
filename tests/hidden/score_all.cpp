#include "tests/hidden/score_all.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>

namespace mpm::hidden {

std::vector<CaseScore> score_all(const std::vector<CaseRequest>& requests, int jobs) {
  std::vector<CaseScore> scores(requests.size());
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const bool terminal = isatty(STDERR_FILENO) != 0;

  const auto work = [&] {
    for (std::size_t i = next++; i < requests.size(); i = next++) {
      try {
        scores[i] = score_one(requests[i]);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        failure = std::current_exception();
        next = requests.size();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
      if (terminal) std::fprintf(stderr, "\r\033[K%zu of %zu cases", done, requests.size());
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int job = 0; job < std::max(jobs, 1); ++job) workers.emplace_back(work);
  }
  if (terminal) std::fputs("\r\033[K", stderr);
  if (failure) std::rethrow_exception(failure);
  return scores;
}

}  // namespace mpm::hidden
