#include "daemon/host/command_token.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "config/failure_text.hpp"

namespace mpm::host {
namespace {

constexpr std::size_t kShortest = 16, kLongest = 4096;  // bytes

std::string hex(const unsigned char* bytes, std::size_t count) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4U];
    text += kDigits[bytes[i] & 0xFU];
  }
  return text;
}

bool equal(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace

CommandToken CommandToken::read(const std::string& path) {
  const auto fail = [&path](const std::string& why) -> std::runtime_error {
    return std::runtime_error("token file " + path + ": " + why);
  };
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw fail(config::failure_text(errno));
  if (!S_ISREG(status.st_mode)) throw fail("is no file");
  if ((status.st_mode & S_IRWXO) != 0)
    throw fail("anybody may read or write it; chmod 0640 or less");
  std::ifstream file(path);
  if (!file) throw fail(config::failure_text(errno));
  std::array<char, kLongest + 1> line{};
  file.getline(line.data(), static_cast<std::streamsize>(line.size()));
  if (!file && file.gcount() == 0) throw fail("nothing is in it");
  std::string secret(line.data());
  while (!secret.empty() && (secret.back() == '\r' || secret.back() == ' ')) secret.pop_back();
  if (secret.size() < kShortest)
    throw fail("its first line must have " + std::to_string(kShortest) +
               " characters at least, such as `openssl rand -hex 32` makes");
  if (!std::all_of(secret.begin(), secret.end(),
                   [](unsigned char letter) { return std::isgraph(letter) != 0; }))
    throw fail("its first line must be of letters, digits and marks without spaces");
  if (secret.size() >= kLongest) throw fail("its first line is too long");
  return CommandToken(secret);
}

std::string CommandToken::proof(std::string_view message) const {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (HMAC(EVP_sha256(), secret_.data(), static_cast<int>(secret_.size()),
           reinterpret_cast<const unsigned char*>(message.data()), message.size(), digest.data(),
           &length) == nullptr)
    throw std::runtime_error("HMAC-SHA-256 is not to be had");
  return hex(digest.data(), length);
}

bool CommandToken::proves(std::string_view message, std::string_view proof) const {
  std::string digits(proof);  // others write them large
  std::transform(digits.begin(), digits.end(), digits.begin(),
                 [](unsigned char digit) { return static_cast<char>(std::tolower(digit)); });
  return equal(this->proof(message), digits);
}

bool CommandToken::is(std::string_view secret) const {
  // Of equal length, whatever is offered.
  return equal(proof(secret), proof(secret_));
}

std::string random_text(int bytes) {
  std::vector<unsigned char> random(static_cast<std::size_t>(bytes));
  if (RAND_bytes(random.data(), bytes) != 1) throw std::runtime_error("no random numbers");
  return hex(random.data(), random.size());
}

}  // namespace mpm::host
