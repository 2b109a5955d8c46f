#include "media/media_type.h"

#include <algorithm>
#include <array>

#include "core/text/ascii.h"

namespace strata {
namespace {

using namespace std::string_view_literals;

struct Magic {
  std::size_t offset;
  std::string_view bytes;
  const char* type;
};

constexpr std::array kMagics = {
    Magic{0, "\xff\xd8\xff"sv, "image/jpeg"},
    Magic{0, "\x89PNG\r\n\x1a\n"sv, "image/png"},
    Magic{0, "II*\0"sv, "image/tiff"},
    Magic{0, "MM\0*"sv, "image/tiff"},
    Magic{0, "II+\0"sv, "image/tiff"},  // BigTIFF
    Magic{0, "MM\0+"sv, "image/tiff"},
    Magic{0, "GIF87a"sv, "image/gif"},
    Magic{0, "GIF89a"sv, "image/gif"},
    Magic{0, "\0\0\0\x0cjP  \r\n\x87\n"sv, "image/jp2"},
    Magic{0, "8BPS\0"sv, "image/vnd.adobe.photoshop"},
    Magic{0, "%PDF-"sv, "application/pdf"},
    Magic{0, "%!PS"sv, "application/postscript"},
    Magic{0, "{\\rtf"sv, "application/rtf"},
    // Office before 2007
    Magic{0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, "application/x-ole-storage"},
    Magic{0, "\x1f\x8b"sv, "application/gzip"},
    Magic{0, "7z\xbc\xaf\x27\x1c"sv, "application/x-7z-compressed"},
    Magic{0, "Rar!\x1a\x07"sv, "application/vnd.rar"},
    Magic{257, "ustar"sv, "application/x-tar"},
    Magic{0, "OggS\0"sv, "application/ogg"},
    Magic{0, "fLaC"sv, "audio/flac"},
    Magic{0, "ID3"sv, "audio/mpeg"},
    Magic{0, "glTF"sv, "model/gltf-binary"},
    Magic{0, "AC10"sv, "image/vnd.dwg"},
};

bool has_at(std::string_view text, std::size_t offset, std::string_view part) {
  return text.size() >= offset + part.size() && text.substr(offset, part.size()) == part;
}

// Distinguishes formats that share a container.
std::string_view riff_type(std::string_view head) {
  if (has_at(head, 8, "WEBP")) return "image/webp";
  if (has_at(head, 8, "WAVE")) return "audio/wav";
  if (has_at(head, 8, "AVI ")) return "video/x-msvideo";
  return {};
}

std::string_view brand_type(std::string_view brand) {
  constexpr std::array kHeif = {"heic"sv, "heix"sv, "hevc"sv, "hevx"sv,
                                "heim"sv, "heis"sv, "mif1"sv, "msf1"sv};
  if (std::find(kHeif.begin(), kHeif.end(), brand) != kHeif.end()) return "image/heic";
  if (brand == "avif" || brand == "avis") return "image/avif";
  if (brand == "qt  ") return "video/quicktime";
  if (brand == "M4A " || brand == "M4B ") return "audio/mp4";
  return "video/mp4";
}

std::string_view zip_type(std::string_view head) {
  // OpenDocument and EPUB files begin with their type, uncompressed.
  for (const auto type :
       {"application/vnd.oasis.opendocument.text"sv,
        "application/vnd.oasis.opendocument.spreadsheet"sv,
        "application/vnd.oasis.opendocument.presentation"sv,
        "application/vnd.oasis.opendocument.graphics"sv, "application/epub+zip"sv})
    if (has_at(head, 30, "mimetype") && has_at(head, 38, type)) return type;
  // Office files contain the names of their parts, in an unspecified order.
  if (head.find("[Content_Types].xml") == std::string_view::npos &&
      head.find("_rels/.rels") == std::string_view::npos)
    return "application/zip";
  if (head.find("word/") != std::string_view::npos)
    return "application/vnd.openxmlformats-officedocument.wordprocessingml.document";
  if (head.find("xl/") != std::string_view::npos)
    return "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet";
  if (head.find("ppt/") != std::string_view::npos)
    return "application/vnd.openxmlformats-officedocument.presentationml.presentation";
  return "application/zip";
}

std::string_view binary_type(std::string_view head) {
  for (const Magic& magic : kMagics)
    if (has_at(head, magic.offset, magic.bytes)) return magic.type;
  if (head.starts_with("RIFF")) return riff_type(head);
  if (has_at(head, 4, "ftyp") && head.size() >= 12) return brand_type(head.substr(8, 4));
  if (head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06")) return zip_type(head);
  if (head.starts_with("\x1a\x45\xdf\xa3"))
    return head.substr(0, 64).find("webm") != std::string_view::npos ? "video/webm"
                                                                     : "video/x-matroska";
  if (head.starts_with("BM") && head.size() >= 14 && has_at(head, 6, "\0\0\0\0"sv))
    return "image/bmp";
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(head[i]); };
  // An MPEG audio frame without a tag before it.
  if (head.size() >= 2 && byte(0) == 0xff && (byte(1) & 0xe6) == 0xe2) return "audio/mpeg";
  return {};
}

bool is_text(std::string_view head) {
  return std::none_of(head.begin(), head.end(), [](char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r' &&
            c != '\f' && c != 27) ||
           c == 127;
  });
}

// Detects markup that a browser would interpret, anywhere in the text.
std::string_view markup_type(std::string_view text) {
  constexpr std::array kHtml = {"<!doctype html"sv,
                                "<html"sv,
                                "<head"sv,
                                "<script"sv,
                                "<iframe"sv,
                                "<h1"sv,
                                "<div"sv,
                                "<font"sv,
                                "<table"sv,
                                "<a"sv,
                                "<style"sv,
                                "<title"sv,
                                "<b"sv,
                                "<body"sv,
                                "<br"sv,
                                "<p"sv,
                                "<meta"sv,
                                "<img"sv,
                                "<form"sv,
                                "<svg"sv,
                                "<object"sv,
                                "<embed"sv,
                                "<link"sv,
                                "<base"sv};
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\f"), text.size()));
  if (!text.starts_with('<')) return {};
  const std::string small = to_lower(text);
  if (small.starts_with("<svg")) return "image/svg+xml";
  const bool is_xml =
      small.starts_with("<?xml") || small.starts_with("<!--") || small.starts_with("<!doctype svg");
  if (is_xml && small.find("<svg") != std::string::npos) return "image/svg+xml";
  if (small.find("<html") != std::string::npos || small.find("<script") != std::string::npos)
    return "text/html";
  for (const auto tag : kHtml)
    if (small.starts_with(tag)) return "text/html";
  return is_xml ? "application/xml" : "";
}

}  // namespace

std::string sniff_media_type(std::span<const std::uint8_t> bytes, std::string_view name) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kSniffedBytes));
  if (const auto type = binary_type(head); !type.empty()) return std::string(type);
  if (head.empty() || !is_text(head)) return "application/octet-stream";
  if (const auto type = markup_type(head); !type.empty()) return std::string(type);
  const auto dot = name.rfind('.');
  const std::string ending =
      dot == std::string_view::npos ? std::string() : to_lower(name.substr(dot + 1));
  if (ending == "csv") return "text/csv";
  if (ending == "json" || ending == "geojson") return "application/json";
  if (ending == "md") return "text/markdown";
  return "text/plain";
}

bool is_raster_picture(std::string_view media_type) {
  constexpr std::array kTypes = {"image/jpeg"sv, "image/png"sv, "image/tiff"sv,
                                 "image/webp"sv, "image/gif"sv, "image/heic"sv,
                                 "image/avif"sv, "image/bmp"sv, "image/jp2"sv};
  return std::find(kTypes.begin(), kTypes.end(), media_type) != kTypes.end();
}

}  // namespace strata
