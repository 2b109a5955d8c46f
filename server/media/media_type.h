#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace strata {

// The number of bytes at the start of a file that suffice to detect all known formats.
inline constexpr std::size_t kSniffedBytes = 64 * 1024;

// Detects the media type of a file from its first bytes. Ignores the type that the sender states.
// `head` contains the whole file or its first kSniffedBytes bytes. Detects images, documents,
// audio, video and archives. Returns "text/html" and "image/svg+xml" for content that a browser
// would run, "text/plain" for other text, and otherwise "application/octet-stream". The extension
// of `name` only distinguishes kinds of plain text (CSV, JSON, Markdown). Follows the WHATWG's MIME
// Sniffing standard for the formats that it covers.
std::string sniff_media_type(std::span<const std::uint8_t> head, std::string_view name);

// Returns whether a media type is a raster image, which browsers show but never run. SVG is not
// a raster image.
bool is_raster_picture(std::string_view media_type);

}  // namespace strata
