#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "mesh/io/input_files.h"

namespace strata::mesh {

constexpr std::uint64_t kMaxArchiveEntries = 10'000;
// Limit for the unpacked size of an archive: a multiple of its size, and a minimum for small ones.
// Scans in text formats compress ten to one.
constexpr std::uint64_t kMaxUnpackGain = 100, kUnpackAlways = 16u << 20;

// Meshes, materials, buffers and pictures.
bool is_scan_file(std::string_view name);

// Unpacks the files of a zip whose names `accepts` accepts, as unnamed files in `scratch` that are
// deleted with their mappings. Other files, and those that macOS adds, are skipped. Names in the
// archive are never used as paths. Refused (invalid): no zip, damaged, encrypted, too many entries,
// unpacking to more than stated; `storage_full` where the disk is full; `cancelled` when cancelled.
Result<std::vector<InputFiles::Entry>> unpack_archive(
    std::span<const std::uint8_t> zip, const std::filesystem::path& scratch, Progress& progress,
    const std::function<bool(std::string_view)>& accepts = is_scan_file);

}  // namespace strata::mesh
