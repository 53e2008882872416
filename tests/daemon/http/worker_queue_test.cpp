#include "daemon/http/worker_queue.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>

namespace mpm::http {
namespace {

TEST_CASE("all jobs are done before the threads end") {
  std::atomic<int> done = 0;
  WorkerQueue queue(3, 4);
  for (int k = 0; k < 100; ++k) queue.add([&done] { ++done; });
  queue.finish();
  CHECK(done == 100);
}

TEST_CASE("who adds to a full queue waits") {
  std::atomic<bool> go = false;
  std::atomic<int> added = 0;
  WorkerQueue queue(1, 2);
  std::thread adder([&] {
    for (int k = 0; k < 6; ++k) {
      queue.add([&go] {
        while (!go) std::this_thread::yield();
      });
      ++added;
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(added <= 3);  // one at work, two waiting
  go = true;
  adder.join();
  CHECK(added == 6);
}

}  // namespace
}  // namespace mpm::http
