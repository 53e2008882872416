#include "daemon/mcap/read/unpacker.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

#include "core/text/printable.hpp"

namespace mpm::mcap {
namespace {

constexpr std::size_t kFirstBytes = 64U << 10U;

/// One step of a decompressor.
struct Step {
  std::size_t taken = 0;  // bytes of input
  std::size_t given = 0;  // bytes of output
  bool frame_done = false;
  const char* error = nullptr;
};

/// Calls step(input, output) until the input is used up or nothing moves any more.
template <class Decompress>
std::string unpack_with(Decompress&& decompress, ByteView packed, std::uint64_t size, Bytes& out) {
  std::size_t used = 0;
  bool frame_done = packed.empty();
  std::string problem;
  out.resize(std::min<std::uint64_t>(size + 1, std::max(out.capacity(), kFirstBytes)));
  while (problem.empty()) {
    if (used == out.size() && used <= size)
      out.resize(std::min<std::uint64_t>(size + 1, 2 * out.size()));  // one more shows an excess
    const Step step = decompress(packed, std::span(out).subspan(used));
    packed = packed.subspan(step.taken);
    used += step.given;
    frame_done = step.frame_done;
    if (step.error != nullptr)
      problem = std::string("cannot be unpacked (") + step.error + ")";
    else if (used > size)
      problem = "unpacks to more than the " + std::to_string(size) + " bytes it names";
    else if (step.taken == 0 && step.given == 0)
      break;
    if (frame_done && packed.empty()) break;
  }
  out.resize(std::min<std::uint64_t>(used, size));
  if (!problem.empty()) return problem;
  if (!frame_done || !packed.empty()) return "has packed data that are cut off";
  if (used != size)
    return "unpacks to " + std::to_string(used) + " bytes, not the " + std::to_string(size) +
           " it names";
  return {};
}

}  // namespace

struct Unpacker::Contexts {
  ZSTD_DCtx* zstd = ZSTD_createDCtx();
  LZ4F_dctx* lz4 = nullptr;
  Contexts() { LZ4F_createDecompressionContext(&lz4, LZ4F_VERSION); }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
  ~Contexts() {
    ZSTD_freeDCtx(zstd);
    LZ4F_freeDecompressionContext(lz4);
  }
};

Unpacker::Unpacker() : contexts_(std::make_unique<Contexts>()) {}
Unpacker::~Unpacker() = default;

std::string Unpacker::unpack(std::string_view compression, ByteView packed, std::uint64_t size,
                             Bytes& out) {
  out.clear();
  if (size > kMostBytes) return "claims to unpack to " + std::to_string(size) + " bytes";
  if (compression.empty()) {
    out.assign(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(
                                                    std::min<std::uint64_t>(packed.size(), size)));
    return packed.size() == size ? ""
                                 : "holds " + std::to_string(packed.size()) + " bytes, not the " +
                                       std::to_string(size) + " it names";
  }
  if (compression == "zstd") {
    ZSTD_DCtx_reset(contexts_->zstd, ZSTD_reset_session_only);
    return unpack_with(
        [this](ByteView in, std::span<std::byte> room) {
          ZSTD_inBuffer input{in.data(), in.size(), 0};
          ZSTD_outBuffer output{room.data(), room.size(), 0};
          const std::size_t left = ZSTD_decompressStream(contexts_->zstd, &output, &input);
          Step step{input.pos, output.pos, left == 0, nullptr};
          if (ZSTD_isError(left) != 0) step.error = ZSTD_getErrorName(left);
          return step;
        },
        packed, size, out);
  }
  if (compression == "lz4") {
    LZ4F_resetDecompressionContext(contexts_->lz4);
    return unpack_with(
        [this](ByteView in, std::span<std::byte> room) {
          std::size_t taken = in.size(), given = room.size();
          const std::size_t left =
              LZ4F_decompress(contexts_->lz4, room.data(), &given, in.data(), &taken, nullptr);
          if (LZ4F_isError(left) != 0) return Step{0, 0, false, LZ4F_getErrorName(left)};
          return Step{taken, given, left == 0, nullptr};
        },
        packed, size, out);
  }
  return "is packed with '" + printable(compression) +
         "', which is not known here (zstd and lz4 are)";
}

}  // namespace mpm::mcap
