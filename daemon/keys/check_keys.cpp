#include "daemon/keys/check_keys.hpp"

#include <sys/stat.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "daemon/files/times/time_text.hpp"
#include "daemon/keys/identity.hpp"
#include "daemon/keys/key_folder.hpp"

namespace mpm::keys {
namespace {

namespace fs = std::filesystem;

class Check {
 public:
  Check(const config::Place& place, fs::path folder) : place_(place), folder_(std::move(folder)) {}

  void tell(config::Severity severity, const std::string& message) {
    findings_.push_back({place_.file, place_.line, place_.column, severity, place_.key, message});
  }
  /// What `look` throws is wrong with that file; false if it does.
  bool of(const char* file, const std::function<void()>& look) {
    try {
      look();
      return true;
    } catch (const std::exception& error) {
      tell(config::Severity::kError, (folder_ / file).string() + ": " + error.what());
      return false;
    }
  }
  /// Nothing, and told, where it cannot be read.
  std::string text(const char* file) {
    try {
      return read_text(folder_ / file);
    } catch (const std::exception& error) {  // names the file
      tell(config::Severity::kError, error.what());
      return "";
    }
  }
  [[nodiscard]] std::vector<config::Finding> take() { return std::move(findings_); }

 private:
  config::Place place_;
  fs::path folder_;
  std::vector<config::Finding> findings_;
};

}  // namespace

std::vector<config::Finding> check_keys(const config::DdsSettings& settings, Role role,
                                        std::time_t now) {
  if (settings.security.empty()) return {};
  const fs::path folder = fs::path(settings.security) / to_string(role);
  Check check(settings.security_at, folder);
  const std::string authority = check.text(kAuthorityFile), key = check.text(kKeyFile),
                    certificate = check.text(kCertificateFile),
                    governance = check.text(kGovernanceFile),
                    permissions = check.text(kPermissionsFile);
  if (authority.empty() || key.empty() || certificate.empty() || governance.empty() ||
      permissions.empty())
    return check.take();
  if (!check.of(kAuthorityFile, [&] { (void)validity_of(authority); })) return check.take();
  check.of(kKeyFile, [&] {
    struct stat status {};
    if (::stat((folder / kKeyFile).c_str(), &status) == 0 && (status.st_mode & S_IRWXO) != 0)
      throw std::runtime_error("anybody may read or write it; chmod 0640 or less");
    (void)Identity::read(certificate, key);
  });
  check.of(kCertificateFile, [&] {
    const std::optional<Role> whose = from_string<Role>(name_of(certificate));
    if (whose && *whose != role)
      throw std::runtime_error("is of the " + std::string(to_string(*whose)) + ", not of the " +
                               std::string(to_string(role)));
    verify_certificate(certificate, authority, now);
    const std::time_t until = validity_of(certificate).until;
    if (std::chrono::seconds(until - now) < kNotice)
      check.tell(config::Severity::kWarning, (folder / kCertificateFile).string() + ": expires " +
                                                 files::formatted_utc(until, "%Y-%m-%dT%H:%M:%SZ"));
  });
  check.of(kGovernanceFile, [&] { verify_signed(governance, authority); });
  check.of(kPermissionsFile, [&] { verify_signed(permissions, authority); });
  return check.take();
}

}  // namespace mpm::keys
