#include "daemon/http/kept_digests.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

#include "config/finding.hpp"
#include "daemon/history/read_journal.hpp"

namespace mpm::http {
namespace {

std::vector<std::string> last_files(const std::string& folder, const std::string& unit,
                                    std::uint64_t most_bytes) {
  std::vector<std::string> files = history::journal_of({folder}, unit);
  std::size_t first = files.size();
  for (std::uint64_t bytes = 0; first > 0; --first) {
    std::error_code gone;
    const std::uintmax_t size = std::filesystem::file_size(files[first - 1], gone);
    if (gone) continue;
    bytes += size;
    if (bytes > most_bytes) break;
  }
  files.erase(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(first));
  return files;
}

}  // namespace

void for_each_kept_digest(const std::string& folder, const std::string& unit,
                          std::uint64_t most_bytes,
                          const std::function<void(const history::Digest&)>& take) {
  const history::JournalReader reader{
      .head = [](const history::UnitHead&) {},
      .digest = [&take](const history::Digest& digest) { take(digest); },
      .alarm = [](const history::AlarmChangeNote&) {}};
  try {
    for (const std::string& file : last_files(folder, unit, most_bytes)) {
      try {
        history::read_journal(file, reader);
      } catch (const config::InputError&) {  // the next file can be read alone
      }
    }
  } catch (const std::exception&) {  // no journal
  }
}

}  // namespace mpm::http
