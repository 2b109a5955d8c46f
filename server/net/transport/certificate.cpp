#include "net/transport/certificate.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <ctime>
#include <fstream>

#include "core/log.h"

namespace strata::net {
namespace {

namespace ssl = boost::asio::ssl;
namespace fs = std::filesystem;

Error unusable(const fs::path& file, const std::string& why, const char* option) {
  return {ErrorCode::invalid, "Certificate cannot be used", "`" + file.string() + "`: " + why + ".",
          option};
}

// Without this check, a file without read permission causes the same error as one without PEM.
Result<void> check_readable(const fs::path& file, const char* option) {
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    return tl::unexpected(unusable(file, "the file does not exist", option));
  if (!std::ifstream(file))
    return tl::unexpected(unusable(file, "the server has no permission to read it", option));
  return {};
}

}  // namespace

Certificate::Times Certificate::written() const {
  std::error_code gone;  // ignored: a missing file gets the minimum time
  return {fs::last_write_time(chain_, gone), fs::last_write_time(key_, gone)};
}

Result<std::shared_ptr<ssl::context>> Certificate::read() const {
  STRATA_TRY(check_readable(chain_, "--tls-cert"));
  STRATA_TRY(check_readable(key_, "--tls-key"));
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  boost::system::error_code error;
  context->set_options(
      ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1, error);
  // Allows only those TLS 1.2 ciphers that correspond to TLS 1.3: ephemeral keys with authenticated
  // encryption (RFC 9325, 4.2).
  SSL_CTX_set_cipher_list(context->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20");
  if (!error) context->use_certificate_chain_file(chain_.string(), error);
  if (error)
    return tl::unexpected(unusable(
        chain_, "it contains no certificate in PEM format: " + error.message(), "--tls-cert"));
  // Without this callback, OpenSSL would wait at the terminal for the passphrase of an encrypted
  // key.
  context->set_password_callback(
      [](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
  context->use_private_key_file(key_.string(), ssl::context::pem, error);
  // OpenSSL accepts a key of a different type because it could belong to a second certificate.
  const bool is_its_key = !error && SSL_CTX_check_private_key(context->native_handle()) == 1;
  ERR_clear_error();
  if (!is_its_key)
    return tl::unexpected(unusable(
        key_, "it is not the key of the certificate, is not in PEM format, or has a passphrase",
        "--tls-key"));
  return context;
}

Result<Certificate> Certificate::load(fs::path chain, fs::path key) {
  Certificate certificate(std::move(chain), std::move(key));
  certificate.read_at_ = certificate.written();
  auto context = STRATA_TRY(certificate.read());
  certificate.context_ = std::move(context);
  return certificate;
}

std::int64_t Certificate::end() const {
  const X509* certificate = SSL_CTX_get0_certificate(context_->native_handle());
  std::tm utc{};
  if (!certificate || ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &utc) != 1) return 0;
  return timegm(&utc);
}

std::shared_ptr<ssl::context> Certificate::context() {
  const Times now = written();
  if (now == read_at_) return context_;
  read_at_ = now;
  if (auto context = read()) {
    context_ = std::move(*context);
    log::info("read the renewed certificate " + chain_.string());
  } else {
    log::warning("the server keeps its current certificate: " + context.error().detail);
  }
  return context_;
}

}  // namespace strata::net
