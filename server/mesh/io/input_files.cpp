#include "mesh/io/input_files.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "core/text/ascii.h"
#include "core/text/utf8.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/unpack.h"

namespace strata::mesh {
namespace {

constexpr std::string_view kTaken =
    "send a PLY, OBJ, STL, glTF, GLB or LAS file, alone, with its textures, or in a zip archive";

// The field of the error for several scans. The page then offers to import them as parts.
constexpr const char* kPartsField = "parts";

// The usual formats of laser scanners that the server cannot read, and what to do with them.
std::string advice_for(std::string_view end) {
  static constexpr std::string_view kCompressed[] = {".laz", ".e57", ".pts", ".ptx",
                                                     ".pcd", ".xyz", ".fls", ".rcp"};
  if (std::ranges::find(kCompressed, end) == std::end(kCompressed))
    return "Please " + std::string(kTaken) + ".";
  return "Export the points as PLY (with colors and normals) or as LAS without compression, for "
         "example with CloudCompare.";
}

std::string_view last_part(std::string_view path) {
  const auto slash = path.find_last_of("/\\");
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

std::string ending(std::string_view filename) {
  const std::string_view name = last_part(filename);
  const auto dot = name.find_last_of('.');
  return dot == std::string_view::npos || dot == 0 ? std::string() : to_lower(name.substr(dot));
}

// Returns the number of equal components of two paths, counted from their ends.
int common_parts(std::string_view a, std::string_view b) {
  int parts = 0;
  while (!a.empty() && !b.empty()) {
    const std::string_view x = last_part(a), y = last_part(b);
    if (to_lower(x) != to_lower(y)) break;
    ++parts;
    a.remove_suffix(std::min(a.size(), x.size() + 1));
    b.remove_suffix(std::min(b.size(), y.size() + 1));
  }
  return parts;
}

// Returns the folders of a file's path.
std::vector<std::string> folders_of(std::string_view name) {
  std::vector<std::string> folders;
  const std::string path = mended_utf8(name);
  std::size_t begin = 0;
  for (std::size_t slash; (slash = path.find_first_of("/\\", begin)) != std::string::npos;
       begin = slash + 1)
    folders.push_back(path.substr(begin, slash - begin));
  return folders;
}

// Returns the number of folders between two folders, or nothing if neither contains the other.
std::optional<std::size_t> steps_between(std::span<const std::string> a,
                                         std::span<const std::string> b) {
  const auto [end_a, end_b] = std::ranges::mismatch(a, b);
  if (end_a != a.end() && end_b != b.end()) return std::nullopt;
  return static_cast<std::size_t>((a.end() - end_a) + (b.end() - end_b));
}

std::vector<std::string> names_of(std::span<const InputFiles::Entry> entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

// Lists the names with their folders, because scans in different folders often have the same name.
std::string listed(std::span<const std::string> filenames, std::span<const std::size_t> which) {
  std::string list;
  for (const std::size_t i : which.first(std::min<std::size_t>(which.size(), 5)))
    list += (list.empty() ? "" : ", ") + mended_utf8(filenames[i]);
  return which.size() > 5 ? list + ", …" : list;
}

}  // namespace

std::filesystem::path scratch_beside(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  return ::access(folder.c_str(), W_OK) == 0 ? folder : std::filesystem::temp_directory_path();
}

InputKind input_kind(std::string_view filename) {
  static constexpr std::pair<std::string_view, InputKind> kKinds[] = {
      {".ply", InputKind::ply},   {".obj", InputKind::obj}, {".stl", InputKind::stl},
      {".gltf", InputKind::gltf}, {".glb", InputKind::glb}, {".las", InputKind::las},
      {".zip", InputKind::zip}};
  const std::string end = ending(filename);
  for (const auto& [name, kind] : kKinds)
    if (name == end) return kind;
  return InputKind::companion;
}

bool is_mesh(InputKind kind) { return kind != InputKind::companion && kind != InputKind::zip; }

Result<std::vector<std::size_t>> pick_scans(std::span<const std::string> filenames, bool parts) {
  std::vector<std::size_t> meshes, archives;
  for (std::size_t i = 0; i < filenames.size(); ++i) {
    const InputKind kind = input_kind(filenames[i]);
    if (is_mesh(kind)) meshes.push_back(i);
    if (kind == InputKind::zip) archives.push_back(i);
  }
  const auto& scans = meshes.empty() ? archives : meshes;
  if (parts && !meshes.empty() && !archives.empty())
    return fail(ErrorCode::invalid, "Scans and archives together",
                "The parts of a model can be several scans or one zip file, but not both: " +
                    listed(filenames, meshes) + ", " + listed(filenames, archives) +
                    ". Unpack the zip file, or put the scans into it.",
                "file");
  if (scans.size() == 1 || (parts && scans.size() <= kMaxModelParts && !meshes.empty()))
    return scans;
  if (parts && scans.size() > kMaxModelParts)
    return fail(ErrorCode::invalid, "Too many scans",
                "The upload contains " + std::to_string(scans.size()) +
                    " scans. A model can have at most " + std::to_string(kMaxModelParts) +
                    " parts. Join some scans, or divide them between several models.",
                "file");
  if (scans.size() > 1)
    return fail(ErrorCode::invalid, "More than one scan",
                "One import creates one model, but the upload contains several scans: " +
                    listed(filenames, scans) + ". Import them one by one" +
                    (meshes.empty() ? "." : ", or with `parts=true` as the parts of one model."),
                meshes.empty() ? "file" : kPartsField);
  if (filenames.empty())
    return fail(ErrorCode::invalid, "No file",
                "The upload contains no file to import. Please " + std::string(kTaken) + ".",
                "file");
  if (filenames.size() == 1 && ending(filenames[0]).empty())
    return fail(ErrorCode::invalid, "File name missing",
                "Send the name of the file, such as NAME.ply or NAME.obj. The end of the name "
                "determines the format.",
                "filename");
  if (filenames.size() == 1)
    return fail(ErrorCode::unsupported, "Unsupported format",
                "'" + ending(filenames[0]) + "' files are not supported. " +
                    advice_for(ending(filenames[0])),
                "filename");
  return fail(ErrorCode::unsupported, "No mesh among the files",
              "None of the " + std::to_string(filenames.size()) + " files is a mesh. Please " +
                  std::string(kTaken) + ".",
              "filename");
}

Result<InputFiles> InputFiles::open(std::span<const InputFile> files, Progress& progress,
                                    bool parts) {
  std::vector<Entry> entries;
  entries.reserve(files.size());
  for (const InputFile& file : files) {
    auto mapped = MappedFile::open(file.path);
    if (!mapped) return refuse_file(mapped.error().detail);
    const auto bytes = mapped->bytes();
    entries.push_back({file.filename, bytes, std::move(*mapped)});
  }
  return of(std::move(entries),
            files.empty() ? std::filesystem::path() : scratch_beside(files[0].path), progress,
            parts);
}

Result<InputFiles> InputFiles::of(std::vector<Entry> entries, const std::filesystem::path& scratch,
                                  Progress& progress, bool parts) {
  auto scans = pick_scans(names_of(entries), parts);
  if (!scans) return tl::unexpected(scans.error());
  if (const Entry& archive = entries[scans->front()]; input_kind(archive.name) == InputKind::zip) {
    if (archive.bytes.empty()) return refuse_file("The file is empty.");
    auto unpacked = STRATA_TRY(unpack_archive(archive.bytes, scratch, progress));
    entries = std::move(unpacked);
    scans = pick_scans(names_of(entries), parts);
    if (!scans) {
      auto refused = refuse_file("In the zip: " + scans.error().detail);
      if (scans.error().field == kPartsField) refused.value().field = kPartsField;
      return refused;
    }
    if (input_kind(entries[scans->front()].name) == InputKind::zip)
      return refuse_file("The zip contains another zip but no mesh. Unpack the outer zip first.");
  }
  InputFiles files;
  files.entries_ = std::move(entries);
  files.scans_ = std::move(*scans);
  return files;
}

const InputFiles::Entry* InputFiles::find(std::string_view reference) const {
  const Entry* best = nullptr;
  int most = 0;
  std::size_t fewest = 0;
  // The name of a referenced file may have been damaged by a wrong encoding.
  const std::string target = mended_utf8(reference);
  const auto scan_folders = folders_of(scan().name);
  for (const Entry& entry : entries_) {
    const int common = common_parts(mended_utf8(entry.name), target);
    if (common == 0 || common < most) continue;
    const auto steps = scans_.size() == 1 ? std::optional<std::size_t>(0)
                                          : steps_between(folders_of(entry.name), scan_folders);
    if (!steps || (common == most && *steps >= fewest)) continue;
    most = common;
    fewest = *steps;
    best = &entry;
  }
  return best;
}

std::vector<const InputFiles::Entry*> InputFiles::own() const {
  const auto scan_folders = folders_of(scan().name);
  const auto is_below = [&](const Entry& entry) {
    const auto folders = folders_of(entry.name);
    return std::ranges::mismatch(scan_folders, folders).in1 == scan_folders.end();
  };
  std::vector<const Entry*> found;
  for (const Entry& entry : entries_)
    if (scans_.size() == 1 || is_below(entry)) found.push_back(&entry);
  const bool shares_folder = scans_.size() > 1 && std::ranges::count_if(scans_, [&](std::size_t i) {
                                                    return is_below(entries_[i]);
                                                  }) > 1;
  return shares_folder ? std::vector<const Entry*>() : found;
}

}  // namespace strata::mesh
