#include "daemon/keys/key_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/failure_text.hpp"
#include "config/whole_file.hpp"

namespace mpm::keys {
namespace {

namespace fs = std::filesystem;

constexpr std::time_t kDay = 86400;  // s
constexpr std::time_t kAuthorityDays = 3650;
constexpr mode_t kSecret = 0600, kOpen = 0644, kSecretFolder = 0700, kOpenFolder = 0755;

[[noreturn]] void fail(const fs::path& path) {
  throw std::runtime_error(path.string() + ": " + config::failure_text(errno));
}

// With its mode from the beginning: a key is nobody else's for no moment.
void write_new(const fs::path& path, const std::string& text, mode_t mode) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0) fail(path);
  const bool written =
      ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file) == 0;
  if (::close(file) != 0 || !written) fail(path);
}

void make_folder(const fs::path& path, mode_t mode) {
  if (::mkdir(path.c_str(), mode) != 0) fail(path);
}

void write_key(const fs::path& folder, const Identity& identity) {
  write_new(folder / kKeyFile, identity.key_pem(), kSecret);
  write_new(folder / kCertificateFile, identity.certificate_pem(), kOpen);
}

/// A folder that goes away unless it is renamed.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(const fs::path& place) : place_(place), path_(place) {
    path_ += ".unfinished-" + std::to_string(::getpid());
    if (::mkdir(path_.c_str(), kOpenFolder) != 0) fail(place_);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  ~UnfinishedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }
  // A folder that has anything in it is not replaced.
  void commit() const {
    if (::rename(path_.c_str(), place_.c_str()) != 0) fail(place_);
  }

 private:
  fs::path place_, path_;
};

}  // namespace

std::string read_text(const fs::path& path) {
  std::string why;
  std::optional<std::string> text = config::read_whole_file(path.string(), why);
  if (text && text->empty()) why = "nothing is in it";
  if (!why.empty()) throw std::runtime_error(path.string() + ": " + why);
  return *std::move(text);
}

void write_participant(const fs::path& folder, const Identity& identity, const Identity& authority,
                       const std::string& permissions) {
  make_folder(folder, kSecretFolder);
  write_key(folder, identity);
  write_new(folder / kAuthorityFile, authority.certificate_pem(), kOpen);
  write_new(folder / kGovernanceFile, authority.sign(governance_xml()), kOpen);
  write_new(folder / kPermissionsFile, authority.sign(permissions), kOpen);
}

std::time_t make_keys(const fs::path& folder, const std::optional<fs::path>& authority, int days,
                      std::time_t now) {
  if (fs::exists(fs::symlink_status(folder)))
    throw std::invalid_argument(folder.string() + " is there; keys are never overwritten");
  const UnfinishedFolder unfinished(folder.has_filename() ? folder : folder.parent_path());
  const std::time_t from = now - kDay;
  std::optional<Identity> voucher;
  if (authority) {
    const std::string certificate = read_text(*authority / kCertificateFile);
    voucher = Identity::read(certificate, read_text(*authority / kKeyFile));
  } else {
    voucher = Identity::authority("mpm bus authority", {from, now + kAuthorityDays * kDay});
    const fs::path own = unfinished.path() / kAuthorityFolder;
    make_folder(own, kSecretFolder);
    write_key(own, *voucher);
  }
  const Validity validity{from, std::min(now + days * kDay, voucher->validity().until)};
  if (validity.until <= now)
    throw std::invalid_argument(authority->string() + ": this authority has expired");
  for (const Role role : kRoles) {
    const std::string name(to_string(role));
    write_participant(unfinished.path() / name, voucher->issue(name, validity), *voucher,
                      permissions_xml(permissions_of(role), "CN=" + name, validity));
  }
  unfinished.commit();
  return validity.until;
}

std::time_t valid_until(const fs::path& folder) {
  return validity_of(read_text(folder / kCertificateFile)).until;
}

}  // namespace mpm::keys
