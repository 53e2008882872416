#include "daemon/keys/identity.hpp"

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::keys {
namespace {

const Validity kValidity{1'700'000'000, 4'000'000'000};

TEST_CASE(
    "a document is signed so that OpenSSL's program verifies it, and what was changed it does "
    "not") {
  const test::TemporaryFolder folder;
  const Identity authority = Identity::authority("authority", kValidity);
  test::write_file(folder.file("ca.pem"), authority.certificate_pem());
  const auto verified = [&](const std::string& text) {
    test::write_file(folder.file("signed"), text);
    return test::run({"/usr/bin/openssl", "smime", "-verify", "-text", "-CAfile",
                      folder.file("ca.pem"), "-in", folder.file("signed")},
                     folder.file("out"), folder.file("err")) == 0;
  };
  std::string text = authority.sign("who may do what\n");
  CHECK(verified(text));
  CHECK(test::read_file(folder.file("out")) == "who may do what\r\n");  // as S/MIME has lines
  CHECK_FALSE(verified(Identity::authority("authority", kValidity).sign("who may do what\n")));
  text.replace(text.find("what"), 4, "all!");
  CHECK_FALSE(verified(text));
}

TEST_CASE("an identity comes back from its texts") {
  const Identity made = Identity::authority("authority", kValidity).issue("monitor", kValidity);
  const Identity read = Identity::read(made.certificate_pem(), made.key_pem());
  CHECK(read.certificate_pem() == made.certificate_pem());
  CHECK(read.validity().from == kValidity.from);
  CHECK(validity_of(made.certificate_pem()).until == kValidity.until);
  const Identity other = Identity::authority("authority", kValidity);
  CHECK_THROWS_WITH(Identity::read(made.certificate_pem(), other.key_pem()),
                    Catch::Contains("certificate and private key"));
  CHECK_THROWS_WITH(Identity::read("no certificate", made.key_pem()),
                    Catch::Contains("certificate: "));
}

}  // namespace
}  // namespace mpm::keys
