#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mpm::boiler {

/// The story cannot go on; what() is for the user.
struct StoryError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A program and its arguments; files are named from the workshop's folder.
using Command = std::vector<std::string>;
/// As it would be typed there, without the partition that keeps a run apart from others.
[[nodiscard]] std::string typed(const Command& command);

/// The folder that is current while it lives, with the shipped `config` in it, so that commands run
/// as the page shows them.
class Workshop {
 public:
  explicit Workshop(const std::filesystem::path& folder);
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  ~Workshop();

  /// Runs to the end and returns what it printed. Throws StoryError, with its last words, where it
  /// fails or is not done in two minutes. From any thread.
  std::string run(const Command& command);
  /// A new name for what a program writes on one of its outputs.
  [[nodiscard]] std::string log_name(const std::string& program);

 private:
  std::filesystem::path before_;
  std::atomic<int> count_{0};
};

/// Does all of them, two at a time, and throws what the first to fail threw.
void two_at_a_time(const std::vector<std::function<void()>>& tasks);

}  // namespace mpm::boiler
