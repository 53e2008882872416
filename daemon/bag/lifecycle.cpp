#include "daemon/bag/lifecycle.hpp"

#include <nlohmann/json.hpp>

namespace mpm::bag {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDigits = "0123456789abcdef";

std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    const auto value = std::to_integer<unsigned>(byte);
    text += kDigits[value >> 4U];
    text += kDigits[value & 15U];
  }
  return text;
}

std::optional<std::vector<std::byte>> bytes_of(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const std::size_t high = kDigits.find(text[i]), low = kDigits.find(text[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    bytes.push_back(static_cast<std::byte>(16 * high + low));
  }
  return bytes;
}

}  // namespace

std::string lifecycle_schema() {
  const Json text = {{"type", "string"}};
  return Json{{"type", "object"},
              {"properties",
               {{"state", {{"type", "string"}, {"enum", {"disposed", "no_writers"}}}},
                {"unit", text},
                {"key", text}}}}
      .dump();
}

std::string lifecycle_text(const idl::RawSample& sample) {
  return Json{{"state", sample.state == idl::InstanceState::kDisposed ? "disposed" : "no_writers"},
              {"unit", idl::unit_of(sample.cdr)},
              {"key", hexadecimal(sample.cdr)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Lifecycle> parse_lifecycle(std::string_view text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("state") || !json.contains("key") ||
      !json["key"].is_string())
    return std::nullopt;
  std::optional<std::vector<std::byte>> key = bytes_of(json["key"].get<std::string>());
  if (!key) return std::nullopt;
  if (json["state"] == "disposed") return Lifecycle{idl::InstanceState::kDisposed, std::move(*key)};
  if (json["state"] == "no_writers")
    return Lifecycle{idl::InstanceState::kNoWriters, std::move(*key)};
  return std::nullopt;
}

}  // namespace mpm::bag
