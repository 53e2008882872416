#include "daemon/report/closed_loop/run_mpmsim.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>

namespace mpm::report {
namespace {

constexpr std::chrono::milliseconds kLook{20};

/// What a child writes to its standard error.
class ErrorText {
 public:
  ErrorText() : fd_(memfd_create("mpmsim-errors", MFD_CLOEXEC)) {
    if (fd_ < 0) throw SimulatorError("mpmsim: no memory for its messages");
  }
  ErrorText(const ErrorText&) = delete;
  ErrorText& operator=(const ErrorText&) = delete;
  ~ErrorText() { close(fd_); }

  [[nodiscard]] int fd() const { return fd_; }
  /// Its first line.
  [[nodiscard]] std::string line() const {
    std::array<char, 1000> text{};
    const ssize_t size = pread(fd_, text.data(), text.size(), 0);
    const std::string all(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return all.substr(0, all.find('\n'));
  }

 private:
  int fd_;
};

pid_t spawn(const std::string& program, const std::vector<std::string>& arguments, int errors) {
  std::vector<std::string> words = {"mpmsim"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, errors, STDERR_FILENO);
  // Whoever interrupts us wants it to end too; we block signals and it must not.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failure =
      posix_spawn(&child, program.c_str(), &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0) throw SimulatorError(program + " cannot be started: " + std::strerror(failure));
  return child;
}

/// Its status, or nothing if it had to be killed.
std::optional<int> wait_for(pid_t child, std::chrono::seconds limit,
                            const std::function<bool()>& stopped) {
  const auto end = std::chrono::steady_clock::now() + limit;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end || stopped()) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(kLook);
  }
  return status;
}

}  // namespace

std::string find_mpmsim() {
  std::error_code failure;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
  std::string program = (self.parent_path() / "mpmsim").string();
  if (failure || access(program.c_str(), X_OK) != 0)
    throw SimulatorError("--scenario needs the simulator, and " + program + " is not there");
  return program;
}

void run_mpmsim(const std::string& program, const std::vector<std::string>& arguments,
                std::chrono::seconds limit, const std::function<bool()>& stopped) {
  const ErrorText errors;
  const std::optional<int> status =
      wait_for(spawn(program, arguments, errors.fd()), limit, stopped);
  if (!status)
    throw SimulatorError("mpmsim was stopped, or took longer than " +
                         std::to_string(limit.count()) + " s");
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) return;
  const std::string line = errors.line();
  throw SimulatorError("mpmsim failed" + (line.empty() ? std::string() : ": " + line));
}

}  // namespace mpm::report
