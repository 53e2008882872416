#include "daemon/keys/identity.hpp"

#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509v3.h>

#include <array>
#include <stdexcept>

namespace mpm::keys {
namespace {

constexpr int kSerialBits = 127;  // positive, and as good as unique

[[noreturn]] void fail(const std::string& what) {
  const char* reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  throw std::runtime_error(what + ": " + (reason != nullptr ? reason : "cannot be read"));
}

template <class T>
T* required(T* made, const char* what) {
  if (made == nullptr) fail(what);
  return made;
}

void require(bool done, const char* what) {
  if (!done) fail(what);
}

template <auto kFree>
struct Deleter {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Bio = std::unique_ptr<BIO, Deleter<BIO_free_all>>;
using Extension = std::unique_ptr<X509_EXTENSION, Deleter<X509_EXTENSION_free>>;
using Number = std::unique_ptr<BIGNUM, Deleter<BN_free>>;
using Signed = std::unique_ptr<PKCS7, Deleter<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, Deleter<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, Deleter<X509_STORE_CTX_free>>;

std::shared_ptr<X509> owned(X509* certificate, const char* what) {
  return {required(certificate, what), X509_free};
}
std::shared_ptr<EVP_PKEY> owned(EVP_PKEY* key, const char* what) {
  return {required(key, what), EVP_PKEY_free};
}

Bio bio_of(const std::string& text) {
  return Bio(required(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), "memory"));
}

template <class Write>
std::string written(Write&& write) {
  const Bio out(required(BIO_new(BIO_s_mem()), "memory"));
  require(write(out.get()) == 1, "writing");
  char* data = nullptr;
  const long length = BIO_get_mem_data(out.get(), &data);
  return {data, static_cast<std::size_t>(length)};
}

void add_extension(X509* certificate, X509* issuer, int which, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(
      required(X509V3_EXT_conf_nid(nullptr, &context, which, value), "extension"));
  require(X509_add_ext(certificate, extension.get(), -1) == 1, "extension");
}

/// `issuer`: null where it vouches for itself.
std::shared_ptr<X509> certificate_of(const std::string& name, EVP_PKEY* key,
                                     const Validity& validity, X509* issuer, EVP_PKEY* issuer_key) {
  const bool authority = issuer == nullptr;
  std::shared_ptr<X509> certificate = owned(X509_new(), "certificate");
  X509* made = certificate.get();
  const Number serial(required(BN_new(), "serial number"));
  require(BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
              BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(made)) != nullptr,
          "serial number");
  X509_NAME* subject = X509_get_subject_name(made);
  require(X509_set_version(made, X509_VERSION_3) == 1 &&
              X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8,
                                         reinterpret_cast<const unsigned char*>(name.c_str()), -1,
                                         -1, 0) == 1 &&
              X509_set_issuer_name(made, authority ? subject : X509_get_subject_name(issuer)) == 1,
          "name of a certificate");
  require(ASN1_TIME_set(X509_getm_notBefore(made), validity.from) != nullptr &&
              ASN1_TIME_set(X509_getm_notAfter(made), validity.until) != nullptr,
          "validity of a certificate");
  require(X509_set_pubkey(made, key) == 1, "key of a certificate");
  X509* voucher = authority ? made : issuer;
  add_extension(made, voucher, NID_basic_constraints,
                authority ? "critical,CA:TRUE,pathlen:0" : "critical,CA:FALSE");
  // It signs documents as well as certificates.
  add_extension(made, voucher, NID_key_usage,
                authority ? "critical,keyCertSign,digitalSignature"
                          : "critical,digitalSignature,keyAgreement");
  add_extension(made, voucher, NID_subject_key_identifier, "hash");
  require(X509_sign(made, authority ? key : issuer_key, EVP_sha256()) > 0, "signing a certificate");
  return certificate;
}

std::shared_ptr<X509> read_certificate(const std::string& pem) {
  return owned(PEM_read_bio_X509(bio_of(pem).get(), nullptr, nullptr, nullptr), "certificate");
}

/// Trusts that authority alone.
Store store_of(const std::string& authority) {
  Store store(required(X509_STORE_new(), "memory"));
  require(X509_STORE_add_cert(store.get(), read_certificate(authority).get()) == 1, "authority");
  return store;
}

std::time_t time_of(const ASN1_TIME* time) {
  std::tm utc{};
  require(ASN1_TIME_to_tm(time, &utc) == 1, "validity of a certificate");
  return timegm(&utc);
}

Validity validity_of(const X509* certificate) {
  return {time_of(X509_get0_notBefore(certificate)), time_of(X509_get0_notAfter(certificate))};
}

std::shared_ptr<EVP_PKEY> new_key() { return owned(EVP_EC_gen("P-256"), "key"); }

}  // namespace

Identity Identity::authority(const std::string& name, const Validity& validity) {
  std::shared_ptr<EVP_PKEY> key = new_key();
  std::shared_ptr<X509> certificate = certificate_of(name, key.get(), validity, nullptr, nullptr);
  return {std::move(certificate), std::move(key)};
}

Identity Identity::issue(const std::string& name, const Validity& validity) const {
  std::shared_ptr<EVP_PKEY> key = new_key();
  std::shared_ptr<X509> certificate =
      certificate_of(name, key.get(), validity, certificate_.get(), key_.get());
  return {std::move(certificate), std::move(key)};
}

Identity Identity::read(const std::string& certificate, const std::string& key) {
  Identity identity(
      read_certificate(certificate),
      owned(PEM_read_bio_PrivateKey(bio_of(key).get(), nullptr, nullptr, nullptr), "private key"));
  require(X509_check_private_key(identity.certificate_.get(), identity.key_.get()) == 1,
          "certificate and private key");
  return identity;
}

// As `openssl smime -sign -text` does.
std::string Identity::sign(const std::string& document) const {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT;
  const Bio text = bio_of(document);
  const Signed made(
      required(PKCS7_sign(certificate_.get(), key_.get(), nullptr, text.get(), kFlags), "signing"));
  const Bio again = bio_of(document);
  return written([&](BIO* out) { return SMIME_write_PKCS7(out, made.get(), again.get(), kFlags); });
}

std::string Identity::certificate_pem() const {
  return written([this](BIO* out) { return PEM_write_bio_X509(out, certificate_.get()); });
}

std::string Identity::key_pem() const {
  return written([this](BIO* out) {
    return PEM_write_bio_PKCS8PrivateKey(out, key_.get(), nullptr, nullptr, 0, nullptr, nullptr);
  });
}

Validity Identity::validity() const { return validity_of(certificate_.get()); }

Validity validity_of(const std::string& certificate) {
  return validity_of(read_certificate(certificate).get());
}

std::string name_of(const std::string& certificate) {
  std::array<char, 256> name{};
  const std::shared_ptr<X509> read = read_certificate(certificate);
  (void)X509_NAME_get_text_by_NID(X509_get_subject_name(read.get()), NID_commonName, name.data(),
                                  static_cast<int>(name.size()));
  return name.data();
}

void verify_certificate(const std::string& certificate, const std::string& authority,
                        std::time_t at) {
  const Store store = store_of(authority);
  const std::shared_ptr<X509> checked = read_certificate(certificate);
  const StoreContext context(required(X509_STORE_CTX_new(), "memory"));
  require(X509_STORE_CTX_init(context.get(), store.get(), checked.get(), nullptr) == 1, "memory");
  X509_STORE_CTX_set_time(context.get(), 0, at);
  const bool verified = X509_verify_cert(context.get()) == 1;
  ERR_clear_error();  // the reason is in the context
  if (!verified)
    throw std::runtime_error(
        X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get())));
}

void verify_signed(const std::string& document, const std::string& authority) {
  BIO* content = nullptr;
  const Signed read(SMIME_read_PKCS7(bio_of(document).get(), &content));
  const Bio owner(content);
  require(read != nullptr, "signed document");
  const Store store = store_of(authority);
  X509_STORE_set_flags(store.get(), X509_V_FLAG_NO_CHECK_TIME);  // told of the certificate
  require(PKCS7_verify(read.get(), nullptr, store.get(), content, nullptr, PKCS7_TEXT) == 1,
          "signature");
}

}  // namespace mpm::keys
