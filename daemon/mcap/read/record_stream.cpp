#include "daemon/mcap/read/record_stream.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "daemon/mcap/format/decode.hpp"

namespace mpm::mcap {
namespace {

constexpr std::size_t kVersionByte = 5;

}  // namespace

RecordStream::RecordStream(InputFile& file) : file_(file) {
  const ByteView begin = file.view(0, std::min<std::uint64_t>(file.size(), kMagic.size()));
  if (std::equal(begin.begin(), begin.end(), kMagic.begin(), kMagic.end())) return;
  if (begin.size() == kMagic.size() &&
      std::equal(begin.begin(), begin.begin() + kVersionByte, kMagic.begin()))
    file.fail(kVersionByte, "is an MCAP file of a version that is not known here");
  file.fail(0, file.size() == 0 ? "the file is empty" : "is no MCAP file");
}

std::optional<RecordHead> RecordStream::stop(std::uint64_t offset, std::string what) {
  damage_ = Damage{offset, std::move(what)};
  done_ = true;
  return std::nullopt;
}

std::optional<RecordHead> RecordStream::next() {
  if (done_) return std::nullopt;
  const std::uint64_t left = file_.size() - next_;
  if (left < kRecordHead)
    return stop(next_, left == 0 ? "the recording has no end" : "a record is cut off");
  Decoder decode(file_.view(next_, kRecordHead));
  const RecordHead head{Op{decode.u8()}, next_, decode.u64()};
  if (head.op == Op{}) return stop(next_, "no record begins here");
  if (head.length > left - kRecordHead) {
    torn_ = head;
    return stop(next_, "a record of " + std::to_string(head.length) + " bytes is cut off after " +
                           std::to_string(left - kRecordHead));
  }
  next_ = head.end();
  if (head.op != Op::kFooter) return head;
  done_ = true;
  if (head.length != kFooterBytes) return stop(head.offset, "a footer of the wrong length");
  const ByteView rest = file_.view(next_, std::min<std::uint64_t>(file_.size() - next_, 9));
  if (!std::equal(rest.begin(), rest.end(), kMagic.begin(), kMagic.end())) {
    if (rest.size() > kMagic.size()) return stop(next_, "something follows the end");
    return stop(next_, "the closing mark is missing");
  }
  return head;
}

void RecordStream::resume(std::uint64_t offset) {
  next_ = offset;
  done_ = false;
  damage_.reset();
  torn_.reset();
}

ByteView RecordStream::content(const RecordHead& head) {
  if (head.length > kMostBytes)
    file_.fail(head.offset, "a record of " + std::to_string(head.length) + " bytes");
  return file_.view(head.content(), head.length);
}

bool is_mcap(const std::string& path) {
  // What is in a pipe would be gone from it, or would be waited for.
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return false;
  std::array<char, kVersionByte> begin{};
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) &&
         std::equal(begin.begin(), begin.end(), kMagic.begin(),
                    [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
}

}  // namespace mpm::mcap
