#pragma once

#include <memory>
#include <string>

#include "daemon/keys/documents.hpp"

struct x509_st;
struct evp_pkey_st;

namespace mpm::keys {

/// A certificate with its private key (elliptic curve P-256). All throw std::runtime_error with
/// OpenSSL's reason where it cannot do it.
class Identity {
 public:
  /// A certificate authority that vouches for itself.
  [[nodiscard]] static Identity authority(const std::string& name, const Validity& validity);
  /// From the PEM texts of both.
  [[nodiscard]] static Identity read(const std::string& certificate, const std::string& key);

  /// A new identity with the subject "CN=`name`" that this authority vouches for.
  [[nodiscard]] Identity issue(const std::string& name, const Validity& validity) const;
  /// `document` signed by this one, as S/MIME.
  [[nodiscard]] std::string sign(const std::string& document) const;

  [[nodiscard]] std::string certificate_pem() const;
  [[nodiscard]] std::string key_pem() const;
  [[nodiscard]] Validity validity() const;

 private:
  Identity(std::shared_ptr<x509_st> certificate, std::shared_ptr<evp_pkey_st> key)
      : certificate_(std::move(certificate)), key_(std::move(key)) {}

  std::shared_ptr<x509_st> certificate_;
  std::shared_ptr<evp_pkey_st> key_;
};

/// Of a certificate alone, as PEM.
[[nodiscard]] Validity validity_of(const std::string& certificate);
/// The common name of its subject: "monitor" where that is "CN=monitor"; empty where it has none.
[[nodiscard]] std::string name_of(const std::string& certificate);
/// Throws std::runtime_error unless the authority vouches for this certificate at that time (both
/// PEM).
void verify_certificate(const std::string& certificate, const std::string& authority,
                        std::time_t at);
/// Throws std::runtime_error unless that authority has signed this document (S/MIME).
void verify_signed(const std::string& document, const std::string& authority);

}  // namespace mpm::keys
