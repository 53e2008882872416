#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/raw_sample.hpp"

namespace mpm::bag {

inline constexpr const char* kLifecycleSuffix = "/_lifecycle";
inline constexpr const char* kLifecycleSchema = "mpm.Lifecycle";

/// JSON Schema of a lifecycle message.
[[nodiscard]] std::string lifecycle_schema();

/// {"state": "disposed" | "no_writers", "unit": ..., "key": hexadecimal CDR}
[[nodiscard]] std::string lifecycle_text(const idl::RawSample& sample);

struct Lifecycle {
  idl::InstanceState state = idl::InstanceState::kDisposed;
  std::vector<std::byte> key;
};
/// The way back; nothing where the text is no such message.
[[nodiscard]] std::optional<Lifecycle> parse_lifecycle(std::string_view text);

}  // namespace mpm::bag
