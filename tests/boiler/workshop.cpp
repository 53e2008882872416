#include "tests/boiler/workshop.hpp"

#include <future>
#include <optional>

#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

constexpr std::chrono::seconds kLongest{120};

}  // namespace

std::string typed(const Command& command) {
  std::string text;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (command[i] == "--partition") {
      ++i;
      continue;
    }
    text += (text.empty() ? "" : " ") + command[i];
  }
  return text;
}

Workshop::Workshop(const std::filesystem::path& folder) : before_(std::filesystem::current_path()) {
  std::filesystem::create_directories(folder);
  std::filesystem::current_path(folder);
  std::filesystem::remove("config");
  std::filesystem::create_directory_symlink(MPM_SOURCE_DIR "/config", "config");
}

Workshop::~Workshop() {
  std::error_code ignored;
  std::filesystem::current_path(before_, ignored);
}

std::string Workshop::log_name(const std::string& program) {
  return program + "-" + std::to_string(++count_) + ".log";
}

std::string Workshop::run(const Command& command) {
  const std::string output = log_name(command.front()), errors = log_name(command.front());
  const std::optional<int> code = test::Process(command, output, errors).wait(kLongest);
  if (code == 0) return test::read_file(output);
  throw StoryError(typed(command) + ": " +
                   (code ? "exit code " + std::to_string(*code) : std::string("takes too long")) +
                   "\n" + test::read_file(errors));
}

void two_at_a_time(const std::vector<std::function<void()>>& tasks) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < tasks.size(); i = next++) tasks[i]();
    } catch (...) {
      next = tasks.size();
      throw;
    }
  };
  std::future<void> other = std::async(std::launch::async, work);
  std::exception_ptr mine;
  try {
    work();
  } catch (...) {
    mine = std::current_exception();
  }
  other.wait();
  if (mine) std::rethrow_exception(mine);
  other.get();
}

}  // namespace mpm::boiler
