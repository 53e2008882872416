#include "daemon/host/logging.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>

#include "core/text/printable.hpp"
#include "daemon/host/terminal.hpp"
#include "idl/log.hpp"

namespace mpm::host {
namespace {

/// %L as syslog priority, see sd-daemon(3).
class SyslogPriority : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    out.push_back(priority_of(message.level));
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<SyslogPriority>();
  }

 private:
  static char priority_of(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return '2';
      case spdlog::level::err:
        return '3';
      case spdlog::level::warn:
        return '4';
      case spdlog::level::info:
        return '6';
      default:
        return '7';
    }
  }
};

constexpr std::size_t kLongestLine = 1000;

void log_dds(idl::LogLevel level, const std::string& message) {
  const std::string line = printable(message, kLongestLine);  // it may hold names from the bus
  switch (level) {
    case idl::LogLevel::kError:
      spdlog::error("dds: {}", line);
      break;
    case idl::LogLevel::kWarning:
      spdlog::warn("dds: {}", line);
      break;
    default:
      spdlog::debug("dds: {}", line);
  }
}

// journald names the stream that it reads, see systemd.exec(5); standard error may have been sent
// elsewhere since.
bool journal_reads_standard_error() {
  const char* named = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  return named != nullptr && fstat(STDERR_FILENO, &status) == 0 &&
         fmt::format("{}:{}", status.st_dev, status.st_ino) == named;
}

}  // namespace

void set_up_logging(const std::string& level) {
  auto logger =
      spdlog::stderr_color_mt("mpm", wants_color(STDERR_FILENO) ? spdlog::color_mode::automatic
                                                                : spdlog::color_mode::never);
  if (journal_reads_standard_error()) {  // it has times of its own
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SyslogPriority>('*').set_pattern("<%*>%v");
    logger->set_formatter(std::move(formatter));
  } else {
    logger->set_pattern("%Y-%m-%d %H:%M:%S %^%l%$ %v");
  }
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(logger));
  idl::set_log_handler(log_dds);
}

}  // namespace mpm::host
