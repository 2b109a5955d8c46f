#pragma once

#include <array>
#include <boost/asio/ssl/context.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/error.h"

namespace strata::net {

// The server certificate for TLS clients (1.2 or later). Consists of a certificate chain and its
// key in PEM files, as Let's Encrypt writes them.
class Certificate {
 public:
  // Returns 422 for `--tls-cert` or `--tls-key` if a file is unreadable or has other content, or if
  // the key does not belong to the certificate.
  static Result<Certificate> load(std::filesystem::path chain, std::filesystem::path key);

  // Returns the TLS context for a new connection. Reads the files again if they have changed. If
  // they are invalid, logs the error and keeps the previous context.
  std::shared_ptr<boost::asio::ssl::context> context();
  // Returns the end of the current certificate, in seconds since 1970.
  std::int64_t end() const;

 private:
  using Times = std::array<std::filesystem::file_time_type, 2>;

  Certificate(std::filesystem::path chain, std::filesystem::path key)
      : chain_(std::move(chain)), key_(std::move(key)) {}
  Times written() const;  // modification times of the files
  Result<std::shared_ptr<boost::asio::ssl::context>> read() const;

  std::filesystem::path chain_, key_;
  Times read_at_{};
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace strata::net
