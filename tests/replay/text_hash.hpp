#pragma once

#include <string>

namespace mpm::test {

/// 16 hexadecimal digits (FNV-1a), so that a text that is not kept cannot change unseen.
[[nodiscard]] std::string hash_of(const std::string& text);

}  // namespace mpm::test
