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

// A file of a scan: the mesh, or a file that it uses (materials, textures, buffers).
struct InputFile {
  // the user's name for it, with folders where known; its ending determines the format
  std::string filename;
  std::filesystem::path path;
};

enum class InputKind { ply, obj, stl, gltf, glb, zip, companion };

// Determines the kind by the ending of a name, in upper or lower case.
InputKind input_kind(std::string_view filename);
bool is_mesh(InputKind kind);

// Returns which of these files is the scan: the only mesh, or the only archive where there is no
// mesh. `invalid` for a file without a name or an ending, `unsupported` without a mesh, `invalid`
// with several; the last two list the files found.
Result<std::size_t> pick_scan(std::span<const std::string> filenames);

// The files of one scan as read-only memory, found by the names with which they refer to each
// other. Any thread, one at a time.
class InputFiles {
 public:
  struct Entry {
    std::string name;
    std::span<const std::uint8_t> bytes;
    std::optional<MappedFile> mapping;  // holds `bytes`, if they are in a file
  };

  // Maps the files into memory. A zip is unpacked in its folder, or in the folder for temporary
  // files, and its content replaces it. Fails as pick_scan and unpack_archive do, and where a file
  // cannot be read.
  static Result<InputFiles> open(std::span<const InputFile> files, Progress& progress);
  // For bytes that outlive this object; a zip is unpacked into `scratch`.
  static Result<InputFiles> of(std::vector<Entry> entries, const std::filesystem::path& scratch,
                               Progress& progress);

  const Entry& scan() const { return entries_[scan_]; }
  std::span<const Entry> all() const { return entries_; }

  // Finds the file that another one refers to by `reference`: a path in the form of any system,
  // perhaps of the machine where the scan was made. The longest common end of the path wins;
  // folders and the case of letters may differ, the last part may not. Null: it was not uploaded.
  const Entry* find(std::string_view reference) const;

 private:
  std::vector<Entry> entries_;
  std::size_t scan_ = 0;
};

}  // namespace strata::mesh
