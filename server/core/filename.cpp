#include "core/filename.h"

#include "core/utf8.h"

namespace strata {

std::string base_filename(std::string_view path) {
  const auto slash = path.find_last_of("/\\");
  if (slash != std::string_view::npos) path.remove_prefix(slash + 1);
  std::string out;
  for (const char c : path)
    if (static_cast<unsigned char>(c) >= 32 && c != 127) out += c;
  if (out == "." || out == "..") out.clear();
  out = mended_utf8(out);
  if (out.size() <= kLongestFilename) return out;
  std::size_t cut = out.size() - kLongestFilename;  // the end holds the extension
  while (!is_utf8(std::string_view(out).substr(cut))) ++cut;
  return out.substr(cut);
}

}  // namespace strata
