#include "support/scan_atlas.h"

#include <filesystem>
#include <map>

#include "mesh/io/load.h"
#include "strata_dirs.h"

namespace strata::test {
namespace {

Result<ScanAtlas> load_and_unwrap(const std::string& name) {
  Progress progress;
  auto scan = mesh::load_mesh(std::filesystem::path(STRATA_TEST_DATA) / name, name, progress);
  if (!scan) return tl::unexpected(scan.error());
  auto atlas = mesh::make_atlas(scan->mesh, 2048, progress);
  if (!atlas) return tl::unexpected(atlas.error());
  return ScanAtlas{std::move(scan->mesh), std::move(*atlas)};
}

}  // namespace

const Result<ScanAtlas>& scan_with_made_atlas(const std::string& name) {
  static std::map<std::string, Result<ScanAtlas>> scans;
  auto found = scans.find(name);
  if (found == scans.end()) found = scans.emplace(name, load_and_unwrap(name)).first;
  return found->second;
}

}  // namespace strata::test
