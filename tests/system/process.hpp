#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mpm::test {

/// A folder of its own that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);
/// What is in a folder and may be read by anybody, or written to by more than its owner.
[[nodiscard]] std::vector<std::string> open_to_others(const std::string& folder);
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

/// One of our programs, running; killed if the test leaves it behind.
class Process {
 public:
  /// `arguments[0]`: mpmd, mpm ..., or the path of another one. Output goes to `output` and
  /// `errors`. `environment`: additional "NAME=value". `input`: file for standard input.
  Process(const std::vector<std::string>& arguments, const std::string& output,
          const std::string& errors, const std::vector<std::string>& environment = {},
          const std::string& input = "/dev/null");
  Process(Process&& other) noexcept : pid_(other.pid_) { other.pid_ = 0; }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  void send(int signal) const;
  /// Exit code, or 128 + signal; nothing if it still runs after `timeout`.
  [[nodiscard]] std::optional<int> wait(std::chrono::milliseconds timeout);
  [[nodiscard]] long resident_kb() const;
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
};

/// Runs to the end (180 s at most: a diagnosis under a sanitizer); returns the exit code.
[[nodiscard]] std::optional<int> run(const std::vector<std::string>& arguments,
                                     const std::string& output, const std::string& errors,
                                     const std::string& input = "/dev/null");

}  // namespace mpm::test
