#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "mesh/io/input_files.h"

namespace strata::mesh {

constexpr std::uint64_t kMaxArchiveEntries = 10'000;
// What an archive unpacks to: so many times its size, and a little for small ones. Scans written as
// text pack ten to one.
constexpr std::uint64_t kMaxUnpackGain = 100, kUnpackAlways = 16u << 20;

// Meshes, materials, buffers and pictures.
bool is_scan_file(std::string_view name);

// The files of a zip that are `wanted` by their names, as files without names in `scratch` that go
// with their mappings; the rest is passed over, and what a Mac adds. Names in the archive are never
// paths here. Refused (invalid): no zip, damaged, encrypted, too many entries, unpacking to more
// than stated; `storage_full` where the disk is full; `cancelled` when cancelled.
Result<std::vector<InputFiles::Entry>> unpack_archive(
    std::span<const std::uint8_t> zip, const std::filesystem::path& scratch, Progress& progress,
    const std::function<bool(std::string_view)>& wanted = is_scan_file);

}  // namespace strata::mesh
