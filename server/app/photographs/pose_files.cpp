#include "app/photographs/pose_files.h"

#include <algorithm>
#include <array>

#include "core/mapped_file.h"
#include "core/text/ascii.h"
#include "mesh/io/unpack.h"

namespace strata::app {
namespace {

// The endings of the files that read_poses knows.
bool is_pose_file(std::string_view name) {
  static constexpr std::array<std::string_view, 6> kEndings{".txt", ".bin", ".xml",
                                                            ".csv", ".xmp", ".out"};
  const std::string lower = to_lower(name);
  return std::ranges::any_of(kEndings,
                             [&](std::string_view ending) { return lower.ends_with(ending); });
}

Result<photo::PosedPhotographs> read_files(const std::vector<PoseUpload>& uploads,
                                           const std::filesystem::path& scratch) {
  std::vector<MappedFile> mapped;
  for (const PoseUpload& upload : uploads)
    mapped.push_back(STRATA_TRY(MappedFile::open(upload.path)));
  std::vector<mesh::InputFiles::Entry> unpacked;
  std::vector<photo::PoseFile> files;
  if (mapped.size() == 1 && mapped.front().view().starts_with("PK\x03\x04")) {
    Progress progress;
    unpacked =
        STRATA_TRY(mesh::unpack_archive(mapped.front().bytes(), scratch, progress, is_pose_file));
    for (const auto& entry : unpacked) files.push_back({entry.name, entry.bytes});
    if (files.empty())
      return fail(ErrorCode::invalid, "No camera poses",
                  "The zip contains no export of camera poses: no .txt, .bin, .xml, .csv, .xmp or "
                  ".out file.");
  } else {
    for (std::size_t i = 0; i < mapped.size(); ++i)
      files.push_back({uploads[i].name, mapped[i].bytes()});
  }
  return photo::read_poses(files);
}

}  // namespace

Result<photo::PosedPhotographs> read_pose_files(const std::vector<PoseUpload>& files,
                                                const std::filesystem::path& scratch, Unit unit,
                                                Unit model_unit) {
  auto read = read_files(files, scratch);
  if (read && read->is_geocentric)
    read = fail(ErrorCode::invalid, "Geocentric poses",
                "Metashape exported geocentric coordinates, because the chunk has a geographic or "
                "projected coordinate system. Duplicate the chunk, choose local coordinates in its "
                "reference settings, and export the model and the cameras from this chunk.");
  if (!read) {
    Error problem = read.error();
    problem.field = "body";
    return tl::unexpected(std::move(problem));
  }
  const double scale = metres_per(unit) / metres_per(model_unit);
  for (auto& photograph : read->photographs) photograph.pose.center *= scale;
  return read;
}

}  // namespace strata::app
