#include "tests/soak/monitor.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace mpm::soak {
namespace {

namespace fs = std::filesystem;

double bytes_in(const std::string& folder) {
  double bytes = 0.0;
  std::error_code failed, gone;
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    if (const auto size = entry->is_regular_file(gone) ? entry->file_size(gone) : 0; !gone)
      bytes += static_cast<double>(size);
  return bytes;
}

}  // namespace

Monitor::Monitor(std::string folder, idl::DomainOptions domain, int port, std::uint64_t seed)
    : folder_(std::move(folder)), domain_(std::move(domain)), port_(port), random_(seed) {
  // What a process ignores its children do: a full disk is to be an error, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  start();
}

std::string Monitor::log_of(int life) const {
  return folder_ + "/mpmd-" + std::to_string(life) + ".log";
}

// Every second one has a clock that is set forth and back by up to an hour now and then.
void Monitor::start() {
  std::vector<std::string> environment;
  if (random_() % 2 == 0)
    environment = {
        std::string("LD_PRELOAD=") + MPM_STEP_CLOCK,
        "MPM_STEP_MS=" + std::to_string(static_cast<int>(random_() % 7'200'000) - 3'600'000),
        "MPM_STEP_EVERY=" + std::to_string(1000 + random_() % 100'000)};
  process_.emplace(
      std::vector<std::string>{"mpmd", "--config", folder_ + "/soak.yaml", "--domain",
                               std::to_string(domain_.domain), "--partition", domain_.partition,
                               "--state-dir", folder_ + "/state", "--journal", folder_ + "/journal",
                               "--journal-keep", "20MB", "--http", std::to_string(port_)},
      "/dev/null", log_of(lives_), environment);
  started_ = std::chrono::steady_clock::now();
}

int Monitor::restart(int signal) {
  process_->send(signal);
  const std::optional<int> code = process_->wait(std::chrono::seconds(60));
  if (!code) throw std::runtime_error("mpmd does not end");
  log_kb_before_ = log_kb();
  fs::remove(log_of(lives_));
  ++lives_;
  start();
  return *code;
}

void Monitor::fill_disk(bool full) const {
  rlimit limit{};
  prlimit(process_->pid(), RLIMIT_FSIZE, nullptr, &limit);
  limit.rlim_cur = full ? 1 : limit.rlim_max;
  prlimit(process_->pid(), RLIMIT_FSIZE, &limit, nullptr);
}

bool Monitor::runs() { return !process_->wait(std::chrono::milliseconds(0)); }

double Monitor::age_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

double Monitor::resident_mb() const {
  return static_cast<double>(process_->resident_kb()) / 1024.0;
}

double Monitor::processor_s() const {
  std::ifstream status("/proc/" + std::to_string(process_->pid()) + "/stat");
  std::string text;
  std::getline(status, text);
  double user = 0.0, system = 0.0;
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string word;
  for (int i = 3; i < 14 && fields >> word; ++i) {
  }
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double Monitor::disk_mb() const {
  return (bytes_in(folder_ + "/state") + bytes_in(folder_ + "/journal")) / 1e6 - alarm_journal_mb();
}

double Monitor::alarm_journal_mb() const {
  double bytes = 0.0;
  for (const char* part : {"", "-wal", "-shm"}) {
    std::error_code gone;
    const auto size = fs::file_size(alarm_journal() + part, gone);
    if (!gone) bytes += static_cast<double>(size);
  }
  return bytes / 1e6;
}

double Monitor::log_kb() const {
  std::error_code failed;
  const auto now = fs::file_size(log_of(lives_), failed);
  return log_kb_before_ + (failed ? 0.0 : static_cast<double>(now) / 1e3);
}

}  // namespace mpm::soak
