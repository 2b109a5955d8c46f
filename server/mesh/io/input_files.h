#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/mapped_file.h"
#include "core/progress.h"

namespace strata::mesh {

// A file of a scan: the mesh, or what goes with it (materials, textures, buffers).
struct InputFile {
  // the user's name of it, with folders where they are known: its ending names the format
  std::string filename;
  std::filesystem::path path;
};

enum class InputKind { ply, obj, stl, gltf, glb, zip, companion };

// By the ending of a name, in upper or lower case.
InputKind input_kind(std::string_view filename);
bool is_mesh(InputKind kind);

// Which of these files is the scan: the one mesh, or the one archive where there is no mesh.
// invalid without a name or an ending, `unsupported` where there is none, `invalid` where there are
// several; both name what was found.
Result<std::size_t> pick_scan(std::span<const std::string> filenames);

// The files of one scan as read-only memory, found by the names they call each other. Thread: any,
// one at a time.
class InputFiles {
 public:
  struct Entry {
    std::string name;
    std::span<const std::uint8_t> bytes;
    std::optional<MappedFile> mapping;  // holds `bytes`, where they are of a file
  };

  // Maps the files into memory; a zip is unpacked beside itself, or where temporary files go, and
  // what is in it takes its place. Refused as by pick_scan, where a file cannot be read, and as by
  // unpack_archive.
  static Result<InputFiles> open(std::span<const InputFile> files, Progress& progress);
  // Of bytes that outlive this; a zip is unpacked into `scratch`.
  static Result<InputFiles> of(std::vector<Entry> entries, const std::filesystem::path& scratch,
                               Progress& progress);

  const Entry& scan() const { return entries_[scan_]; }
  std::span<const Entry> all() const { return entries_; }

  // The file that another one means by `reference`: a path as written on any system, perhaps of the
  // machine where the scan was made. The longest common end of the path wins; folders and the case
  // of letters may differ, the last part may not. Null: it was not sent along.
  const Entry* find(std::string_view reference) const;

 private:
  std::vector<Entry> entries_;
  std::size_t scan_ = 0;
};

}  // namespace strata::mesh
