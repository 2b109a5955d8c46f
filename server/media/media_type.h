#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace strata {

// of the file's begin: enough for all known formats
inline constexpr std::size_t kSniffedBytes = 64 * 1024;

// Returns the type of a file from its first bytes (all of them, or kSniffedBytes), not from the
// sender's claim: a media type of pictures, documents, sounds, videos and archives, "text/html" and
// "image/svg+xml" for content that a browser would run, "text/plain" for other text, otherwise
// "application/octet-stream". The extension of `name` only distinguishes kinds of plain text (CSV,
// JSON, Markdown). Follows the WHATWG's MIME sniffing standard for its formats.
std::string sniff_media_type(std::span<const std::uint8_t> head, std::string_view name);

// Raster pictures, which browsers show and never run; a drawing (SVG) is a document.
bool is_raster_picture(std::string_view media_type);

}  // namespace strata
