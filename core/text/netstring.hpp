#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// Appends `field` as "LENGTH:BYTES," (D. J. Bernstein, 1997): lists of fields that can be told
/// apart whatever is in them, to be signed or summed.
inline void append_netstring(std::string& text, std::string_view field) {
  text += std::to_string(field.size());
  text += ':';
  text += field;
  text += ',';
}

}  // namespace mpm
