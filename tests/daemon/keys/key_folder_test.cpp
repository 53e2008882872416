#include "daemon/keys/key_folder.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <ctime>
#include <filesystem>

#include "tests/system/process.hpp"

namespace mpm::keys::key_folder_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

constexpr std::time_t kDay = 86400;

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  REQUIRE(::lstat(path.c_str(), &status) == 0);
  return status.st_mode & 07777U;
}

/// OpenSSL's program, which is another one than what made the files.
int openssl(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "/usr/bin/openssl");
  return test::run(arguments, folder.file("out"), folder.file("err")).value_or(-1);
}

TEST_CASE("each role has all that it needs, and its key is nobody else's") {
  const TemporaryFolder folder;
  const fs::path made = folder.file("keys");
  const std::time_t now = std::time(nullptr);
  CHECK(make_keys(made, std::nullopt, 30, now) == now + 30 * kDay);
  for (const Role role : kRoles) {
    const fs::path own = made / to_string(role);
    CAPTURE(own);
    CHECK(mode_of(own) == 0700);
    CHECK(mode_of(own / kKeyFile) == 0600);
    CHECK(valid_until(own) == now + 30 * kDay);
    const std::string authority = own / kAuthorityFile;
    CHECK(openssl(folder, {"verify", "-CAfile", authority, own / kCertificateFile}) == 0);
    for (const char* document : {kGovernanceFile, kPermissionsFile})
      CHECK(openssl(folder, {"smime", "-verify", "-text", "-CAfile", authority, "-in",
                             own / document}) == 0);
    // The permissions, which are verified last, are of this certificate's subject.
    CHECK(test::read_file(folder.file("out"))
              .find("<subject_name>CN=" + std::string(to_string(role)) + "</subject_name>") !=
          std::string::npos);
  }
  CHECK(mode_of(made / kAuthorityFolder) == 0700);
  CHECK(mode_of(made / kAuthorityFolder / kKeyFile) == 0600);
  CHECK(std::distance(fs::directory_iterator(made), {}) == 5);
}

TEST_CASE("keys are never overwritten, and new ones come from the authority that there is") {
  const TemporaryFolder folder;
  const fs::path first = folder.file("keys"), second = folder.file("keys-2");
  const std::time_t now = std::time(nullptr);
  (void)make_keys(first, std::nullopt, 30, now);
  const std::string key = test::read_file(first / "monitor" / kKeyFile);
  CHECK_THROWS_WITH(make_keys(first, std::nullopt, 30, now), Catch::Contains("never overwritten"));
  CHECK(test::read_file(first / "monitor" / kKeyFile) == key);

  // An authority of ten years vouches for nobody beyond these.
  CHECK(make_keys(second, first / kAuthorityFolder, 4000, now) == now + 3650 * kDay);
  CHECK_FALSE(fs::exists(second / kAuthorityFolder));
  CHECK(test::read_file(second / "monitor" / kKeyFile) != key);
  CHECK(openssl(folder, {"verify", "-CAfile", first / "gateway" / kAuthorityFile,
                         second / "viewer" / kCertificateFile}) == 0);

  CHECK_THROWS_WITH(
      make_keys(folder.file("keys-3"), first / kAuthorityFolder, 30, now + 3651 * kDay),
      Catch::Contains("has expired"));
  CHECK_THROWS_WITH(make_keys(folder.file("keys-3"), folder.file("none"), 30, now),
                    Catch::Contains("none/certificate.pem: No such file"));
  for (const auto& entry : fs::directory_iterator(first.parent_path()))
    CHECK(entry.path().filename().string().find("keys-3") == std::string::npos);

  fs::create_directories(folder.file("ca") + "/certificate.pem");
  CHECK_THROWS_WITH(make_keys(folder.file("keys-3"), folder.file("ca"), 30, now),
                    Catch::Contains("ca/certificate.pem: Is a directory"));
}

}  // namespace
}  // namespace mpm::keys::key_folder_test
