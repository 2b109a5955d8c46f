#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "mesh/io/input_files.h"

namespace strata::mesh {

constexpr std::uint64_t kMaxArchiveEntries = 10'000;
// The limit for the unpacked size of an archive is kMaxUnpackGain times its size plus
// kUnpackAlways, which matters for small archives. Scans in text formats compress about ten to one.
constexpr std::uint64_t kMaxUnpackGain = 100, kUnpackAlways = 16u << 20;

// Returns true for meshes, materials, buffers and images.
bool is_scan_file(std::string_view name);

// Unpacks the files of a zip for whose names `accepts` returns true. They become unnamed files in
// `scratch` and are deleted with their mappings. Other files and files added by macOS are skipped.
// Names in the archive are never used as paths. Fails with `invalid` if the file is not a zip, is
// damaged or encrypted, or exceeds the limits above. Fails with `storage_full` if the disk is full
// and with `cancelled` when cancelled.
Result<std::vector<InputFiles::Entry>> unpack_archive(
    std::span<const std::uint8_t> zip, const std::filesystem::path& scratch, Progress& progress,
    const std::function<bool(std::string_view)>& accepts = is_scan_file);

}  // namespace strata::mesh
