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

// A file of a scan. It is the mesh or a file used by the mesh (materials, textures, buffers).
struct InputFile {
  // the user's name of the file, with folders if known; the extension determines the format
  std::string filename;
  std::filesystem::path path;
};

enum class InputKind { ply, obj, stl, gltf, glb, las, zip, companion };

// Determines the kind of a file from the extension of its name, in upper or lower case.
InputKind input_kind(std::string_view filename);
bool is_mesh(InputKind kind);

// Returns the index of the scan: the only mesh, or the only archive if there is no mesh. Fails with
// `invalid` if no file, name or extension is given. Fails with `unsupported` if there is no mesh,
// and with `invalid` if there are several meshes. The last error lists the meshes.
Result<std::size_t> pick_scan(std::span<const std::string> filenames);

// The files of one scan in read-only memory. A file can be found by the name with which another
// file refers to it. Can be used on any thread, but only on one thread at a time.
class InputFiles {
 public:
  struct Entry {
    std::string name;
    std::span<const std::uint8_t> bytes;
    std::optional<MappedFile> mapping;  // holds `bytes` if they are in a file
  };

  // Maps the files into memory. A zip is replaced by its content. It is unpacked in its own folder
  // or in the folder for temporary files. Fails like pick_scan and unpack_archive, and if a file
  // cannot be read.
  static Result<InputFiles> open(std::span<const InputFile> files, Progress& progress);
  // The bytes must outlive this object. A zip is unpacked into `scratch`.
  static Result<InputFiles> of(std::vector<Entry> entries, const std::filesystem::path& scratch,
                               Progress& progress);

  const Entry& scan() const { return entries_[scan_]; }
  std::span<const Entry> all() const { return entries_; }

  // Finds the file that another file refers to by `reference`. The reference is a path in the
  // syntax of any system, possibly of the computer where the scan was made. The file with the
  // longest common end of the path is used. Folders and upper or lower case may differ, but the
  // last component must match. Returns null if the file was not uploaded.
  const Entry* find(std::string_view reference) const;

 private:
  std::vector<Entry> entries_;
  std::size_t scan_ = 0;
};

}  // namespace strata::mesh
