#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "idl/topics.hpp"

namespace mpm::idl {

/// Serialised samples to and from the types of the IDL, without a domain or participant. A
/// serialised sample begins with the four bytes that say how it is encoded.
class Cdr {
 public:
  explicit Cdr(const dds_topic_descriptor_t* type) : type_(type) {}
  Cdr(const Cdr&) = delete;
  Cdr& operator=(const Cdr&) = delete;
  ~Cdr();

  /// Into `sample`, a value of the type: zeroed before the first call, then reused. False where
  /// `bytes` are no sample of this type (any encoding that the type may have, either byte order);
  /// every length is checked before it is believed.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, void* sample);
  /// Little-endian, as writers of DDS do it here; valid until the next call.
  [[nodiscard]] std::span<const std::byte> encode(const void* sample);
  /// Frees what `decode` made.
  void release(void* sample) const;

 private:
  const dds_topic_descriptor_t* type_;
  std::vector<std::uint64_t> words_;  // aligned as the decoder needs it
  std::vector<std::byte> bytes_;
};

/// Decodes samples of type T one after the other.
template <class T>
class CdrDecoder {
 public:
  CdrDecoder() = default;
  CdrDecoder(const CdrDecoder&) = delete;
  CdrDecoder& operator=(const CdrDecoder&) = delete;
  ~CdrDecoder() { cdr_.release(&sample_); }

  /// Null where `bytes` are no T; valid until the next call.
  [[nodiscard]] const T* decode(std::span<const std::byte> bytes) {
    return cdr_.decode(bytes, &sample_) ? &sample_ : nullptr;
  }

 private:
  Cdr cdr_{TopicType<T>::descriptor()};
  T sample_{};
};

/// Encodes samples of type T one after the other.
template <class T>
class CdrEncoder {
 public:
  /// Valid until the next call.
  [[nodiscard]] std::span<const std::byte> encode(const T& sample) { return cdr_.encode(&sample); }

 private:
  Cdr cdr_{TopicType<T>::descriptor()};
};

}  // namespace mpm::idl
