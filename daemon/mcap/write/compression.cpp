#include "daemon/mcap/write/compression.hpp"

#include <zstd.h>

#include <stdexcept>
#include <string>

namespace mpm::mcap {
namespace {

// 2: of the fast levels the one that still finds what control data repeat.
constexpr int kLevel = 2;

}  // namespace

struct Compressor::Context {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { ZSTD_freeCCtx(zstd); }
};

std::string_view name_of(Compression compression) {
  return compression == Compression::kZstd ? "zstd" : "";
}

Compressor::Compressor(Compression compression) {
  if (compression == Compression::kZstd) context_ = std::make_unique<Context>();
}

Compressor::~Compressor() = default;

ByteView Compressor::pack(ByteView bytes) {
  if (!context_) return bytes;
  packed_.resize(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compressCCtx(context_->zstd, packed_.data(), packed_.size(),
                                             bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0)
    throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  return ByteView(packed_).first(size);
}

}  // namespace mpm::mcap
