#include "core/text/filename.h"

#include <algorithm>

#include "core/text/utf8.h"

namespace strata {
namespace {

// Removes C1 controls, zero-width spaces and direction marks, line and paragraph separators,
// embeddings and overrides, isolates, and the byte order mark. `text` is UTF-8.
std::string without_unseen(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
    const std::size_t size = byte(0) < 0x80 ? 1 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
    const unsigned code = size == 2 ? (byte(0) & 0x1fu) << 6 | (byte(1) & 0x3fu)
                          : size == 3
                              ? (byte(0) & 0x0fu) << 12 | (byte(1) & 0x3fu) << 6 | (byte(2) & 0x3fu)
                              : byte(0);
    const bool unseen = (code >= 0x80 && code < 0xa0 && size == 2) ||
                        (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
                        (code >= 0x2060 && code <= 0x2069) || code == 0xfeff || code == 0x61c;
    if (!unseen) out += text.substr(at, size);
    at += size;
  }
  return out;
}

}  // namespace

std::string base_filename(std::string_view path) {
  const auto slash = path.find_last_of("/\\");
  if (slash != std::string_view::npos) path.remove_prefix(slash + 1);
  std::string out;
  for (const char c : path)
    if (static_cast<unsigned char>(c) >= 32 && c != 127) out += c;
  out = without_unseen(mended_utf8(out));
  if (out == "." || out == "..") out.clear();
  if (out.size() <= kMaxFilenameLength) return out;
  std::size_t cut = out.size() - kMaxFilenameLength;  // keeps the extension, which is at the end
  while (!is_utf8(std::string_view(out).substr(cut))) ++cut;
  return out.substr(cut);
}

std::string filename_stem(std::string_view path) {
  const std::string base = base_filename(path);
  const auto dot = base.find_last_of('.');
  return dot == std::string::npos || dot == 0 ? base : base.substr(0, dot);
}

std::string relative_filename(std::string_view path) {
  std::string relative;
  while (!path.empty()) {
    const auto end = std::min(path.find_first_of("/\\"), path.size());
    const std::string part = base_filename(path.substr(0, end));
    if (!part.empty() && !part.ends_with(':')) relative += (relative.empty() ? "" : "/") + part;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return relative;
}

}  // namespace strata
