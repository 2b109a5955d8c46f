#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

// Content codings of answers (RFC 9110, 8.4): gzip and Brotli, if the client accepts them.
namespace strata::net {

enum class Coding { gzip, brotli };
std::string_view name(Coding coding);  // in Content-Encoding: "gzip", "br"

// Returns the best coding that an Accept-Encoding header accepts; nothing if the header is absent
// or accepts neither (quality 0 is a refusal).
std::optional<Coding> accepted_coding(std::string_view accept_encoding);

// Compresses one content; for one thread at a time.
class Compressor {
 public:
  explicit Compressor(Coding coding);
  ~Compressor();
  Compressor(Compressor&&) noexcept;
  Compressor& operator=(Compressor&&) noexcept;

  // Returns the compressed bytes that are ready, with `last` all of them. May be empty before.
  std::vector<std::uint8_t> add(std::span<const std::uint8_t> bytes, bool last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Compresses texts of at least a kilobyte (JSON, CSV, HTML, …) with a coding that the client
// accepts. Skips answers that have a coding or ranges already, and `no-store` answers, which
// contain a secret. A streamed answer loses its length. The ETag gets the coding's name, since it
// identifies one representation. A 304 names the client's tag, one of `known_tags`.
void compress(Response& response, std::string_view accept_encoding,
              std::string_view known_tags = {});

// Removes the suffixes of `compress` from If-Match and If-None-Match, so that handlers compare
// their own ETags; Request::known_tags keeps the original.
void forget_codings(Request& request);

}  // namespace strata::net
