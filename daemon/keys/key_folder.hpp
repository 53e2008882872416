#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/keys/documents.hpp"
#include "daemon/keys/identity.hpp"

namespace mpm::keys {

/// What is in the folder of a participant; idl/participant reads it.
inline constexpr const char* kAuthorityFile = "ca.pem";
inline constexpr const char* kCertificateFile = "certificate.pem";
inline constexpr const char* kKeyFile = "key.pem";
inline constexpr const char* kGovernanceFile = "governance.p7s";
inline constexpr const char* kPermissionsFile = "permissions.p7s";
/// Of the authority, beside the participants'.
inline constexpr const char* kAuthorityFolder = "ca";

/// What such a file holds; throws std::runtime_error with its name and the reason.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// All that `identity` needs to take part with these permissions, which `authority` signs. Throws
/// std::runtime_error where it cannot be written, or is there.
void write_participant(const std::filesystem::path& folder, const Identity& identity,
                       const Identity& authority, const std::string& permissions);

/// Makes `folder` with a folder for each role, whole or not at all. `authority`: the folder of one
/// that was made before; without it a new one is made, and is there too. The participants'
/// certificates and permissions are valid from a day before `now` to `days` after it, but no longer
/// than the authority's; a new authority ten years. Throws std::invalid_argument where `folder` is
/// there (keys are never overwritten) or the authority has expired, std::runtime_error where it
/// cannot be done. Returns until when the participants may take part.
std::time_t make_keys(const std::filesystem::path& folder,
                      const std::optional<std::filesystem::path>& authority, int days,
                      std::time_t now);

/// Until when the certificate in a participant's folder is valid; throws std::runtime_error.
[[nodiscard]] std::time_t valid_until(const std::filesystem::path& folder);

}  // namespace mpm::keys
