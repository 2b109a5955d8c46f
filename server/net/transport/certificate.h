#pragma once

#include <array>
#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>

#include "core/error.h"

namespace strata::net {

// What the server shows to clients that speak TLS (1.2 or later): a certificate chain and its key,
// PEM files as Let's Encrypt writes them.
class Certificate {
 public:
  // 422 `--tls-cert` or `--tls-key`: a file that cannot be read, or holds something else; a key of
  // another certificate.
  static Result<Certificate> load(std::filesystem::path chain, std::filesystem::path key);

  // For a new connection. The files are read anew when they have changed; what cannot be used then
  // is logged, and what was there stays.
  std::shared_ptr<boost::asio::ssl::context> context();

 private:
  using Times = std::array<std::filesystem::file_time_type, 2>;

  Certificate(std::filesystem::path chain, std::filesystem::path key)
      : chain_(std::move(chain)), key_(std::move(key)) {}
  Times written() const;  // when each file was
  Result<std::shared_ptr<boost::asio::ssl::context>> read() const;

  std::filesystem::path chain_, key_;
  Times read_at_{};
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace strata::net
