#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace strata {

// of a file's beginning: enough for all that is known
inline constexpr std::size_t kSniffedBytes = 64 * 1024;

// What a file is by its first bytes (all of them, or kSniffedBytes), whatever its sender calls it:
// a media type of pictures, documents, sounds, videos and archives that people attach, "text/html"
// and "image/svg+xml" for what a browser would run, "text/plain" for other text,
// "application/octet-stream" for the rest. The ending of `name` decides only between kinds of plain
// text (CSV, JSON, Markdown). After the WHATWG's MIME sniffing standard, where it knows the format.
std::string sniff_media_type(std::span<const std::uint8_t> head, std::string_view name);

// Pictures made of pixels, which browsers show and never run; a drawing (SVG) is a document.
bool is_raster_picture(std::string_view media_type);

}  // namespace strata
