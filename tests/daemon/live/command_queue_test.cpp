#include "daemon/live/command_queue.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

namespace mpm::live {
namespace {

using namespace std::chrono_literals;

CommandReply accept(const AlarmCommand& command) { return {true, command.user}; }
void ignore(const AlarmCommand&, const std::string&) {}

TEST_CASE("the loop answers who asks") {
  CommandQueue queue;
  std::atomic<bool> stop = false;
  std::thread loop([&] {
    while (!stop) {
      queue.serve(accept, ignore);
      std::this_thread::sleep_for(1ms);
    }
  });
  std::vector<std::thread> askers;
  askers.reserve(8);
  std::atomic<int> right = 0;
  for (int k = 0; k < 8; ++k)
    askers.emplace_back([&, k] {
      AlarmCommand command;
      command.user = std::to_string(k);
      const CommandReply reply = queue.ask(command);
      if (reply.accepted && reply.text == command.user) ++right;
    });
  for (std::thread& asker : askers) asker.join();
  stop = true;
  loop.join();
  CHECK(right == 8);
}

TEST_CASE("a loop that does not turn leaves nobody waiting, and carries nothing out later") {
  CommandQueue queue(30ms);
  CHECK_FALSE(queue.ask({}).accepted);
  int served = 0;
  queue.serve(
      [&](const AlarmCommand& command) {
        ++served;
        return accept(command);
      },
      ignore);
  CHECK(served == 0);
}

TEST_CASE("no more wait than are meant to") {
  CommandQueue queue(300ms);
  std::vector<std::thread> askers;
  askers.reserve(CommandQueue::kMostWaiting);
  for (std::size_t k = 0; k < CommandQueue::kMostWaiting; ++k)
    askers.emplace_back([&] { (void)queue.ask({}); });
  std::this_thread::sleep_for(100ms);
  const auto before = std::chrono::steady_clock::now();
  CHECK(queue.ask({}).text == "too many commands wait; try again");
  CHECK(std::chrono::steady_clock::now() - before < 100ms);
  for (std::thread& asker : askers) asker.join();
}

TEST_CASE("what was refused is handed on once, and a flood of it is not kept") {
  CommandQueue queue;
  for (std::size_t k = 0; k < 10 * CommandQueue::kMostWaiting; ++k)
    queue.tell_refused({}, "no " + std::to_string(k));
  std::vector<std::string> told;
  const auto note = [&](const AlarmCommand&, const std::string& why) { told.push_back(why); };
  queue.serve(accept, note);
  REQUIRE(told.size() == CommandQueue::kMostWaiting);
  CHECK(told.front() == "no 0");
  queue.serve(accept, note);
  CHECK(told.size() == CommandQueue::kMostWaiting);
}

}  // namespace
}  // namespace mpm::live
