#include "daemon/keys/check_keys.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "daemon/keys/key_folder.hpp"
#include "tests/system/process.hpp"

namespace mpm::keys::check_keys_test {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::write_file;

constexpr std::time_t kDay = 86400;

/// Keys that are valid for 40 days from `now`, and what is said of the monitor's.
struct Checked {
  Checked() {
    (void)make_keys(keys, std::nullopt, 40, now);
    settings.security = keys;
    settings.security_at = {"u.yaml", 8, 17, "dds.security"};
  }
  [[nodiscard]] std::vector<std::string> said(std::time_t at) const {
    std::vector<std::string> lines;
    for (const config::Finding& finding : check_keys(settings, Role::kMonitor, at))
      lines.push_back(format(finding));
    return lines;
  }
  [[nodiscard]] std::string at(const char* file) const { return monitor / file; }

  std::time_t now = std::time(nullptr);
  test::TemporaryFolder folder;
  fs::path keys = folder.file("keys"), monitor = keys / "monitor";
  config::DdsSettings settings;
};

const std::string kHead = "u.yaml:8:17: error: dds.security: ";

TEST_CASE("sound keys raise no finding until thirty days before they expire") {
  Checked checked;
  CHECK(checked.said(checked.now).empty());
  CHECK(checked.said(checked.now + 10 * kDay).empty());
  const std::vector<std::string> soon = checked.said(checked.now + 10 * kDay + 1);
  REQUIRE(soon.size() == 1);
  CHECK_THAT(soon[0], Catch::StartsWith("u.yaml:8:17: warning: dds.security: " +
                                        checked.at(kCertificateFile) + ": expires 20"));
  // The words are those of OpenSSL for X509_V_ERR_CERT_HAS_EXPIRED.
  CHECK(checked.said(checked.now + 40 * kDay + 1).front() ==
        kHead + checked.at(kCertificateFile) + ": certificate has expired");
  checked.settings.security.clear();
  CHECK(checked.said(checked.now).empty());
}

TEST_CASE(
    "each file that is missing or is not what it should be is named, at the place that asks for "
    "it") {
  const Checked checked;
  const Identity rogue =
      Identity::authority("mpm bus authority", {checked.now - kDay, checked.now + kDay});
  const auto said_with = [&](const char* file, const std::string& text) {
    const std::string before = read_file(checked.at(file));
    const auto put = [&](const std::string& content) {
      write_file(checked.at(file), content);
      fs::permissions(checked.at(file), fs::perms::owner_read | fs::perms::owner_write);
    };
    put(text);
    std::vector<std::string> lines = checked.said(checked.now);
    put(before);
    for (std::string& line : lines) CHECK_THAT(line, Catch::StartsWith(kHead));
    REQUIRE(!lines.empty());
    return lines.front().substr(kHead.size());
  };
  CHECK_THAT(
      said_with(kCertificateFile, rogue.issue("monitor", rogue.validity()).certificate_pem()),
      Catch::StartsWith(checked.at(kKeyFile) + ": certificate and private key: "));
  CHECK_THAT(said_with(kAuthorityFile, rogue.certificate_pem()),
             Catch::StartsWith(checked.at(kCertificateFile) + ": "));
  CHECK_THAT(said_with(kPermissionsFile, rogue.sign("anything")),
             Catch::StartsWith(checked.at(kPermissionsFile) + ": signature: "));
  CHECK_THAT(said_with(kGovernanceFile, "anything"),
             Catch::StartsWith(checked.at(kGovernanceFile) + ": signed document: "));
  CHECK_THAT(said_with(kKeyFile, "anything"),
             Catch::StartsWith(checked.at(kKeyFile) + ": private key: "));
  CHECK(said_with(kAuthorityFile, "anything") ==
        checked.at(kAuthorityFile) + ": certificate: no start line");  // the words of OpenSSL
  CHECK(said_with(kKeyFile, "") == checked.at(kKeyFile) + ": nothing is in it");

  const fs::path gateway = checked.keys / "gateway";
  fs::rename(checked.monitor, checked.folder.file("monitor"));
  fs::copy(gateway, checked.monitor);
  CHECK(checked.said(checked.now) == std::vector{kHead + checked.at(kCertificateFile) +
                                                 ": is of the gateway, not of the monitor"});
  fs::remove_all(checked.monitor);
  fs::rename(checked.folder.file("monitor"), checked.monitor);

  fs::permissions(checked.monitor / kKeyFile, fs::perms::others_read, fs::perm_options::add);
  CHECK(checked.said(checked.now) ==
        std::vector{kHead + checked.at(kKeyFile) +
                    ": anybody may read or write it; chmod 0640 or less"});
  fs::remove(checked.monitor / kKeyFile);
  fs::remove(checked.monitor / kAuthorityFile);
  CHECK(checked.said(checked.now) ==
        std::vector{kHead + checked.at(kAuthorityFile) + ": No such file or directory",
                    kHead + checked.at(kKeyFile) + ": No such file or directory"});
}

}  // namespace
}  // namespace mpm::keys::check_keys_test
