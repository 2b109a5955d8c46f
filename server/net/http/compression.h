#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

// The content codings of responses (RFC 9110, 8.4). The server uses gzip and Brotli if the client
// accepts them.
namespace strata::net {

enum class Coding { gzip, brotli };
std::string_view name(Coding coding);  // as in Content-Encoding: "gzip", "br"

// Returns the best coding that an Accept-Encoding header accepts. Returns nothing if the header is
// absent or accepts no supported coding. A quality of 0 is a refusal.
std::optional<Coding> accepted_coding(std::string_view accept_encoding);

// Compresses one content. Not thread-safe.
class Compressor {
 public:
  explicit Compressor(Coding coding);
  ~Compressor();
  Compressor(Compressor&&) noexcept;
  Compressor& operator=(Compressor&&) noexcept;

  // Adds bytes and returns the compressed bytes that are ready. Without `last`, the result may be
  // empty. With `last`, returns all remaining bytes.
  std::vector<std::uint8_t> add(std::span<const std::uint8_t> bytes, bool last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Compresses texts of at least a kilobyte (JSON, CSV, HTML, …) with a coding that the client
// accepts. Skips responses that already have a coding or ranges. Skips `no-store` responses because
// they contain a secret. Removes the length of a streamed response. The name of the coding is added
// to the ETag because an ETag identifies one representation. A 304 response gets the tag from
// `known_tags` that matches it.
void compress(Response& response, std::string_view accept_encoding,
              std::string_view known_tags = {});

// Removes the suffixes that `compress` adds from If-Match and If-None-Match, so handlers can
// compare their own ETags. Request::known_tags keeps the original text.
void forget_codings(Request& request);

}  // namespace strata::net
