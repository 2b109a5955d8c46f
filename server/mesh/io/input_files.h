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

// Returns the folder for temporary files of a scan: its own folder, because that of an upload has
// free space, or the system's if its folder is read-only.
std::filesystem::path scratch_beside(const std::filesystem::path& file);

// Determines the kind of a file from the extension of its name, in upper or lower case.
InputKind input_kind(std::string_view filename);
bool is_mesh(InputKind kind);

// Returns the indices of the scans: the only mesh, or the only archive if there is no mesh. With
// `parts`, also several meshes, at most kMaxModelParts. Fails with `invalid` if no file, name or
// extension is given. Fails with `unsupported` if there is no mesh, and with `invalid` if there are
// too many meshes. The last error lists the meshes.
Result<std::vector<std::size_t>> pick_scans(std::span<const std::string> filenames,
                                            bool parts = false);

// The files of one or several scans in read-only memory. A file can be found by the name with which
// another file refers to it. Can be used on any thread, but only on one thread at a time.
class InputFiles {
 public:
  struct Entry {
    std::string name;
    std::span<const std::uint8_t> bytes;
    std::optional<MappedFile> mapping;  // holds `bytes` if they are in a file
  };

  // Maps the files into memory. A zip is replaced by its content. It is unpacked in its own folder
  // or in the folder for temporary files. Fails like pick_scans and unpack_archive, and if a file
  // cannot be read.
  static Result<InputFiles> open(std::span<const InputFile> files, Progress& progress,
                                 bool parts = false);
  // The bytes must outlive this object. A zip is unpacked into `scratch`.
  static Result<InputFiles> of(std::vector<Entry> entries, const std::filesystem::path& scratch,
                               Progress& progress, bool parts = false);

  std::size_t scan_count() const { return scans_.size(); }
  // Chooses the scan, from 0 to scan_count() - 1, that `scan` returns. At first, it is scan 0.
  void choose_scan(std::size_t number) { scan_ = number; }
  const Entry& scan() const { return entries_[scans_[scan_]]; }
  std::span<const Entry> all() const { return entries_; }

  // Finds the file that another file refers to by `reference`. The reference is a path in the
  // syntax of any system, possibly of the computer where the scan was made. The file with the
  // longest common end of the path is used, or of several such files the one that is nearest to the
  // scan. Folders and upper or lower case may differ, but the last component must match. Returns
  // null if the file was not uploaded, or if it can only belong to other scans.
  const Entry* find(std::string_view reference) const;
  // Returns the files that no other scan can use: all of them for a single scan, otherwise those in
  // the folder of the scan and its folders, if it contains no other scan.
  std::vector<const Entry*> own() const;

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> scans_;  // indices of entries
  std::size_t scan_ = 0;            // index of `scans_`
};

}  // namespace strata::mesh
