#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

// Content codings of answers (RFC 9110, 8.4): gzip and Brotli, as the client takes them.
namespace strata::net {

enum class Coding { gzip, brotli };
std::string_view name(Coding coding);  // in Content-Encoding: "gzip", "br"

// The best one that an Accept-Encoding header takes; nothing: it takes neither (quality 0 is a
// refusal), or there is none.
std::optional<Coding> accepted_coding(std::string_view accept_encoding);

// One content on its way out; for one thread at a time.
class Compressor {
 public:
  explicit Compressor(Coding coding);
  ~Compressor();
  Compressor(Compressor&&) noexcept;
  Compressor& operator=(Compressor&&) noexcept;

  // What is ready of the content so far; with `last` all of it. May be empty before.
  std::vector<std::uint8_t> add(std::span<const std::uint8_t> bytes, bool last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Texts of at least a kilobyte (JSON, CSV, HTML, …) leave in a coding that the client's
// Accept-Encoding takes. Passed over: what has a coding or ranges of its own, and what is
// `no-store` because a secret stands in it. A streamed answer loses its length. The ETag gets the
// coding's name: it names one representation. One that says that nothing changed names the tag that
// the client knows, which is one of `known_tags`.
void compress(Response& response, std::string_view accept_encoding,
              std::string_view known_tags = {});

// Drops from If-Match and If-None-Match what `compress` added, so that handlers compare the ETags
// that they gave; Request::known_tags keeps what was sent.
void forget_codings(Request& request);

}  // namespace strata::net
