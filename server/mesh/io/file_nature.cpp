#include "mesh/io/file_nature.h"

#include <array>
#include <string_view>

#include "mesh/io/plain_text.h"
#include "mesh/io/text_number.h"

namespace strata::mesh {
namespace {

using namespace std::string_view_literals;

struct Nature {
  std::string_view begins, is, advice;
  InputKind kind = InputKind::companion;
};

// A failed download is usually the web page that links to the file.
constexpr std::string_view kUnpack = "Unpack it and import its files.",
                           kFetch = "Download the mesh itself.",
                           kExport = "Export the mesh as PLY, OBJ, STL or glTF.";
constexpr std::array<Nature, 28> kNatures{{
    {"PK\3\4"sv, "a zip archive", "Unpack it, or change the end of its name to .zip.",
     InputKind::zip},
    {"\x1f\x8b"sv, "a gzip archive", kUnpack},
    {"\xfd"
     "7zXZ\0"sv,
     "an xz archive", kUnpack},
    {"7z\xbc\xaf\x27\x1c"sv, "a 7-Zip archive", kUnpack},
    {"\x28\xb5\x2f\xfd"sv, "a Zstandard archive", kUnpack},
    {"BZh"sv, "a bzip2 archive", kUnpack},
    {"Rar!"sv, "a RAR archive", kUnpack},
    {"\x89PNG"sv, "a PNG picture", kFetch},
    {"\xff\xd8\xff"sv, "a JPEG picture", kFetch},
    {"II*\0"sv, "a TIFF picture", kFetch},
    {"MM\0*"sv, "a TIFF picture", kFetch},
    {"%PDF"sv, "a PDF document", kFetch},
    {"<!DOCTYPE html"sv, "a web page", kFetch},
    {"<!doctype html"sv, "a web page", kFetch},
    {"<html"sv, "a web page", kFetch},
    {"<HTML"sv, "a web page", kFetch},
    {"<?xml"sv, "an XML document", kExport},
    {"version https://git-lfs"sv, "a reference that Git LFS leaves in place of a file",
     "Fetch the file with git lfs pull."},
    {"Kaydara FBX"sv, "an FBX file", kExport},
    {"; FBX"sv, "an FBX file", kExport},
    {"BLENDER"sv, "a Blender file", kExport},
    {"LASF"sv, "a LAS point cloud", "Change the end of its name to .las.", InputKind::las},
    {"ASTM-E57"sv, "an E57 point cloud",
     "Export the points as PLY, for example with CloudCompare."},
    {"#VRML"sv, "a VRML file", kExport},
    {"ply\n"sv, "a PLY file", "Change the end of its name to .ply.", InputKind::ply},
    {"ply\r"sv, "a PLY file", "Change the end of its name to .ply.", InputKind::ply},
    {"glTF"sv, "a GLB file", "Change the end of its name to .glb.", InputKind::glb},
    {"solid "sv, "an STL file", "Change the end of its name to .stl.", InputKind::stl},
}};

}  // namespace

std::optional<std::string> other_nature(std::span<const std::uint8_t> bytes, InputKind kind) {
  const std::span<const std::uint8_t> rest = bytes.subspan(utf8_mark(bytes));
  std::string_view text(reinterpret_cast<const char*>(rest.data()), rest.size());
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  for (const Nature& nature : kNatures) {
    if (!text.starts_with(nature.begins)) continue;
    if (nature.kind == kind || (nature.kind == InputKind::glb && kind == InputKind::gltf))
      return std::nullopt;
    return "The content of the file is " + std::string(nature.is) + ". " +
           std::string(nature.advice);
  }
  const bool json =
      text.starts_with('{') && text.substr(0, 65536).find("\"asset\"") != std::string_view::npos;
  if (json && kind != InputKind::gltf && kind != InputKind::glb)
    return "The content of the file is glTF. Change the end of its name to .gltf.";
  return std::nullopt;
}

}  // namespace strata::mesh
