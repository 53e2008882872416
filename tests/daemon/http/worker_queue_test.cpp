#include "daemon/http/worker_queue.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

namespace mpm::http {
namespace {

TEST_CASE("all jobs are done before the threads end") {
  std::atomic<int> done = 0;
  WorkerQueue queue(3, 100);
  for (int k = 0; k < 100; ++k) CHECK(queue.add([&done] { ++done; }));
  queue.finish();
  CHECK(done == 100);
}

TEST_CASE("a full queue takes no job") {
  std::atomic<bool> begun = false, go = false;
  WorkerQueue queue(1, 2);
  const auto job = [&] {
    begun = true;
    while (!go) std::this_thread::yield();
  };
  CHECK(queue.add(job));
  while (!begun) std::this_thread::yield();
  CHECK(queue.add(job));
  CHECK(queue.add(job));
  CHECK_FALSE(queue.add(job));
  go = true;
}

}  // namespace
}  // namespace mpm::http
