#include "net/http/compression.h"

#include <brotli/encode.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <variant>

#include "core/text/ascii.h"
#include "core/text/bytes.h"
#include "net/http/accept.h"

namespace strata::net {

// Medium levels instead of the strongest, because clients wait for the result.
constexpr int kGzipLevel = 5;
constexpr int kBrotliQuality = 4;

// Not in the unnamed namespace, because it is the type of a class member.
struct GzipStream {
  GzipStream() {
    constexpr int kGzipWindow = 15 + 16;  // zlib's number for the gzip format
    if (deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~GzipStream() { deflateEnd(&stream); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  void add(std::span<const std::uint8_t> bytes, bool last, std::vector<std::uint8_t>& out) {
    std::array<std::uint8_t, 16384> piece;
    // Adds the bytes in parts because zlib has 32-bit counters.
    do {
      const std::size_t n = std::min<std::size_t>(bytes.size(), 1u << 30);
      stream.next_in = const_cast<Bytef*>(bytes.data());
      stream.avail_in = static_cast<uInt>(n);
      bytes = bytes.subspan(n);
      const int flush = last && bytes.empty() ? Z_FINISH : Z_NO_FLUSH;
      do {
        stream.next_out = piece.data();
        stream.avail_out = piece.size();
        if (deflate(&stream, flush) == Z_STREAM_ERROR)
          throw std::logic_error("deflate: used out of order");
        out.insert(out.end(), piece.data(), piece.data() + (piece.size() - stream.avail_out));
      } while (stream.avail_out == 0);
    } while (!bytes.empty());
  }

  z_stream stream{};
};

struct BrotliStream {
  BrotliStream() : encoder(BrotliEncoderCreateInstance(nullptr, nullptr, nullptr)) {
    if (!encoder) throw std::bad_alloc();
    BrotliEncoderSetParameter(encoder, BROTLI_PARAM_QUALITY, kBrotliQuality);
    // Uses 256 KiB per stream instead of the default of 4 MiB.
    BrotliEncoderSetParameter(encoder, BROTLI_PARAM_LGWIN, 18);
    BrotliEncoderSetParameter(encoder, BROTLI_PARAM_MODE, BROTLI_MODE_TEXT);
  }
  ~BrotliStream() { BrotliEncoderDestroyInstance(encoder); }
  BrotliStream(const BrotliStream&) = delete;
  BrotliStream& operator=(const BrotliStream&) = delete;

  void add(std::span<const std::uint8_t> bytes, bool last, std::vector<std::uint8_t>& out) {
    const auto operation = last ? BROTLI_OPERATION_FINISH : BROTLI_OPERATION_PROCESS;
    std::size_t left = bytes.size();
    const std::uint8_t* at = bytes.data();
    do {
      std::size_t no_room = 0;
      if (!BrotliEncoderCompressStream(encoder, operation, &left, &at, &no_room, nullptr, nullptr))
        throw std::runtime_error("Brotli's encoder failed");
      std::size_t size = 0;
      while (const std::uint8_t* ready = BrotliEncoderTakeOutput(encoder, &size)) {
        if (size == 0) break;
        out.insert(out.end(), ready, ready + size);
        size = 0;
      }
    } while (left > 0 || BrotliEncoderHasMoreOutput(encoder) ||
             (last && !BrotliEncoderIsFinished(encoder)));
  }

  BrotliEncoderState* encoder;
};

namespace {

constexpr std::size_t kMinBytes = 1024;  // a shorter text fits into one packet anyway

bool is_text(std::string_view content_type) {
  const std::string type = to_lower(trimmed(content_type.substr(0, content_type.find(';'))));
  return type.starts_with("text/") || type == "application/json" || type.ends_with("+json") ||
         type.ends_with("+xml") || type == "application/xml" || type == "application/javascript";
}

// Turns `"v3"` into `"v3-br"`. A weak tag stays weak.
std::string with_coding(std::string_view etag, Coding coding) {
  std::string text(etag);
  if (text.size() >= 2 && text.back() == '"')
    text.insert(text.size() - 1, "-" + std::string(name(coding)));
  return text;
}

void set(Response& response, std::string_view header_name, std::string value) {
  for (auto& [key, old] : response.headers)
    if (to_lower(key) == to_lower(header_name)) {
      old = std::move(value);
      return;
    }
  response.with(std::string(header_name), std::move(value));
}

// If the client already has the content in a coding, sets the ETag of that representation.
void name_known_tag(Response& response, std::string_view known_tags) {
  response.with("Vary", "Accept-Encoding");
  const std::string etag(response.header("ETag"));
  if (etag.empty() || known_tags.find(etag) != std::string_view::npos) return;
  for (const Coding coding : {Coding::gzip, Coding::brotli})
    if (const std::string coded = with_coding(etag, coding);
        known_tags.find(coded) != std::string_view::npos)
      return set(response, "ETag", coded);
}

}  // namespace

std::string_view name(Coding coding) { return coding == Coding::gzip ? "gzip" : "br"; }

std::optional<Coding> accepted_coding(std::string_view accept_encoding) {
  std::optional<double> gzip, brotli, any;
  for (const auto& [coding, quality] : accepted_values(accept_encoding)) {
    if (coding == "gzip" || coding == "x-gzip") gzip = quality;
    if (coding == "br") brotli = quality;
    if (coding == "*") any = quality;
  }
  const double of_gzip = gzip.value_or(any.value_or(0)),
               of_brotli = brotli.value_or(any.value_or(0));
  if (of_gzip <= 0 && of_brotli <= 0) return std::nullopt;
  return of_brotli >= of_gzip ? Coding::brotli : Coding::gzip;
}

struct Compressor::State {
  std::variant<std::monostate, GzipStream, BrotliStream> coder;
};

Compressor::Compressor(Coding coding) : state_(std::make_unique<State>()) {
  if (coding == Coding::gzip)
    state_->coder.emplace<GzipStream>();
  else
    state_->coder.emplace<BrotliStream>();
}
Compressor::~Compressor() = default;
Compressor::Compressor(Compressor&&) noexcept = default;
Compressor& Compressor::operator=(Compressor&&) noexcept = default;

std::vector<std::uint8_t> Compressor::add(std::span<const std::uint8_t> bytes, bool last) {
  std::vector<std::uint8_t> out;
  if (auto* gzip = std::get_if<GzipStream>(&state_->coder)) gzip->add(bytes, last, out);
  if (auto* brotli = std::get_if<BrotliStream>(&state_->coder)) brotli->add(bytes, last, out);
  return out;
}

void compress(Response& response, std::string_view accept_encoding, std::string_view known_tags) {
  if (response.status == 304) return name_known_tag(response, known_tags);
  if (!is_text(response.header("Content-Type")) || response.events || !response.file.empty())
    return;
  for (const char* of_its_own : {"Content-Encoding", "Content-Range", "Accept-Ranges"})
    if (!response.header(of_its_own).empty()) return;
  if (response.header("Cache-Control") == "no-store") return;  // the response contains a secret
  if (!response.stream && std::max(response.body.size(), response.bytes.size()) < kMinBytes) return;
  response.with("Vary", "Accept-Encoding");
  const auto coding = accepted_coding(accept_encoding);
  if (!coding) return;
  if (response.stream) {
    const auto write = response.stream->write;
    response.stream->length.reset();
    response.stream->write = [write, coding = *coding](const Response::Sink& sink) {
      Compressor compressor(coding);
      const bool written = write([&](std::span<const std::uint8_t> bytes) {
        const auto ready = compressor.add(bytes, false);
        return ready.empty() || sink(ready);
      });
      return written && sink(compressor.add({}, true));
    };
  } else {
    Compressor compressor(*coding);
    response.bytes =
        compressor.add(response.bytes.empty() ? bytes_of(response.body) : response.bytes, true);
    response.body.clear();
  }
  response.with("Content-Encoding", std::string(name(*coding)));
  if (const auto etag = response.header("ETag"); !etag.empty())
    set(response, "ETag", with_coding(etag, *coding));
}

void forget_codings(Request& request) {
  for (auto& [key, value] : request.headers) {
    if (key != "if-match" && key != "if-none-match") continue;
    if (key == "if-none-match") request.known_tags = value;
    for (const Coding coding : {Coding::gzip, Coding::brotli}) {
      const std::string end = "-" + std::string(name(coding)) + "\"";
      for (auto at = value.find(end); at != std::string::npos; at = value.find(end, at))
        value.replace(at, end.size(), "\"");
    }
  }
}

}  // namespace strata::net
