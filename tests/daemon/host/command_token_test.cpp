#include "daemon/host/command_token.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

namespace mpm::host {
namespace {

struct TokenFile {
  explicit TokenFile(const std::string& text, mode_t mode = 0640) {
    std::ofstream(path) << text;
    ::chmod(path.c_str(), mode);
  }
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;
  ~TokenFile() { ::unlink(path.c_str()); }
  std::string path = "command_token_test." + std::to_string(::getpid());
};

TEST_CASE("a proof is HMAC-SHA-256, as RFC 4231 computes it") {
  // Test case 2 there; its key is short, which `read` would not take.
  CHECK(CommandToken("Jefe").proof("what do ya want for nothing?") ==
        "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

TEST_CASE("a proof fits its message and its token alone") {
  const CommandToken token("0123456789abcdef");
  const std::string proof = token.proof("acknowledge");
  CHECK(token.proves("acknowledge", proof));
  CHECK_FALSE(token.proves("acknowledge!", proof));
  std::string large = proof;
  for (char& digit : large)
    digit = static_cast<char>(std::toupper(static_cast<unsigned char>(digit)));
  CHECK(large != proof);
  CHECK(token.proves("acknowledge", large));
  CHECK_FALSE(token.proves("acknowledge", proof.substr(1)));
  CHECK_FALSE(token.proves("acknowledge", ""));
  CHECK_FALSE(CommandToken("0123456789abcdeF").proves("acknowledge", proof));
  CHECK(token.is("0123456789abcdef"));
  CHECK_FALSE(token.is("0123456789abcde"));
  CHECK_FALSE(token.is(""));
}

TEST_CASE("a token is the first line of its file") {
  const TokenFile file("0123456789abcdef\r\nand so on\n");
  CHECK(CommandToken::read(file.path).is("0123456789abcdef"));
}

TEST_CASE("a token that is short, missing or open to all is refused") {
  const auto refused = [](const std::string& path) {
    try {
      (void)CommandToken::read(path);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(refused("no/such/token"), Contains("No such file"));
  const TokenFile open("0123456789abcdef\n", 0644);
  CHECK_THAT(refused(open.path), Contains("chmod 0640"));
  {
    const TokenFile small("0123456789abcde\n");
    CHECK_THAT(refused(small.path), Contains("16 characters"));
  }
  {
    const TokenFile spaced("0123456789 abcdef\n");
    CHECK_THAT(refused(spaced.path), Contains("without spaces"));
  }
  {
    const TokenFile large(std::string(100'000, 'x'));
    CHECK_THAT(refused(large.path), Contains("too long"));
  }
  CHECK_THAT(refused("/dev/zero"), Contains("is no file"));
}

}  // namespace
}  // namespace mpm::host
