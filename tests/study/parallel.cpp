#include "tests/study/parallel.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>

namespace mpm::study {
namespace {

using Clock = std::chrono::steady_clock;

void show_bar(const std::string& label, double share, double samples, double seconds) {
  constexpr int kWidth = 30;
  const int full = std::clamp(static_cast<int>(share * kWidth), 0, kWidth);
  std::fprintf(stderr, "\r\033[K%-28s [%s%s] %3.0f %%  %.0f samples/s", label.c_str(),
               std::string(static_cast<std::size_t>(full), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - full), ' ').c_str(), 100.0 * share,
               seconds > 0.0 ? samples / seconds : 0.0);
}

}  // namespace

std::vector<RunRecord> run_all(const Prepared& prepared, int threads, const std::string& label) {
  const SeedRange seeds = prepared.experiment.seeds;
  std::vector<RunRecord> records(static_cast<std::size_t>(seeds.count()));
  std::atomic<std::int64_t> progress{0};
  std::atomic<std::size_t> next{0};
  std::atomic<int> working{std::max(threads, 1)};
  std::mutex failure_mutex;
  std::exception_ptr failure;

  const auto work = [&] {
    for (std::size_t i = next++; i < records.size(); i = next++) {
      try {
        records[i] = run_one(prepared, seeds.first + i, progress);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        failure = std::current_exception();
        next = records.size();
      }
    }
    --working;
  };
  std::vector<std::jthread> workers;
  for (int t = 0; t < std::max(threads, 1); ++t) workers.emplace_back(work);

  if (isatty(STDERR_FILENO) != 0) {
    const double total = static_cast<double>(seeds.count()) * prepared.experiment.samples;
    const Clock::time_point begin = Clock::now();
    while (working > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      const auto done = static_cast<double>(progress);
      show_bar(label, done / total, done,
               std::chrono::duration<double>(Clock::now() - begin).count());
    }
    std::fputs("\r\033[K", stderr);
  }
  workers.clear();
  if (failure) std::rethrow_exception(failure);
  return records;
}

}  // namespace mpm::study
