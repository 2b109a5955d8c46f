#include <algorithm>

#include "core/text/ascii.h"
#include "core/text/filename.h"
#include "media/photographs/pose_reader.h"

namespace strata::photo {
namespace {

enum class Kind {
  colmap_cameras_text,
  colmap_images_text,
  colmap_cameras_binary,
  colmap_images_binary,
  metashape,
  realitycapture_csv,
  realitycapture_xmp,
  bundle,
  other_text,
  other,
};

constexpr std::size_t kHead = 64 << 10;  // bytes that decide about the kind of a file

// Returns the kind of a text whose first line with data begins with these words. COLMAP's readers
// do not need the comments before it.
Kind kind_of_data(std::string_view text) {
  while (!text.empty()) {
    std::string_view words = trimmed(take_line(text));
    if (words.empty() || words.starts_with('#')) continue;
    if (!whole_number(take_word(words))) return Kind::other_text;
    const std::string_view second = take_word(words);
    const bool is_model = second.size() > 2 && std::ranges::all_of(second, [](char c) {
                            return (c >= 'A' && c <= 'Z') || c == '_';
                          });
    // rigs.txt has "1 2 CAMERA 1", frames.txt fewer numbers before "CAMERA"; points3D.txt has three
    // whole numbers as colors.
    if (is_model && whole_number(take_word(words))) return Kind::colmap_cameras_text;
    int numbers = finite_number(second) ? 1 : 0;
    while (numbers > 0 && numbers < 7 && finite_number(take_word(words))) ++numbers;
    if (numbers < 7 || !whole_number(take_word(words))) return Kind::other_text;
    const std::string_view name = trimmed(words);
    return !name.empty() && !finite_number(name.substr(0, name.find_first_of(" \t")))
               ? Kind::colmap_images_text
               : Kind::other_text;
  }
  return Kind::other_text;
}

Kind kind_of_text(std::string_view head) {
  std::string_view rest = head;
  const std::string_view first = trimmed(take_line(rest));
  if (first.starts_with("# Bundle file")) return Kind::bundle;
  if (first.starts_with("# Camera list")) return Kind::colmap_cameras_text;
  if (first.starts_with("# Image list")) return Kind::colmap_images_text;
  const std::string names =
      to_lower(to_lower(first).starts_with("#cameras") ? trimmed(take_line(rest)) : first);
  if (names.starts_with("#name") && names.find("roll") != std::string::npos)
    return Kind::realitycapture_csv;
  return kind_of_data(head);
}

Kind kind_of(const PoseFile& file) {
  const std::string name = plain_name(file.name);
  if (name == "cameras.bin") return Kind::colmap_cameras_binary;
  if (name == "images.bin") return Kind::colmap_images_binary;
  const std::string_view head = without_byte_order_mark(text_of(file).substr(0, kHead));
  if (head.find('\0') != std::string_view::npos) return Kind::other;
  if (trimmed(head).starts_with('<')) {
    if (head.find("<x:xmpmeta") != std::string_view::npos) return Kind::realitycapture_xmp;
    return head.find("<document") != std::string_view::npos ? Kind::metashape : Kind::other;
  }
  return kind_of_text(head);
}

std::string shown_name(PoseFormat format) {
  switch (format) {
    case PoseFormat::colmap: return "COLMAP";
    case PoseFormat::metashape: return "Metashape";
    case PoseFormat::realitycapture: return "RealityCapture";
    case PoseFormat::bundler: break;
  }
  return "Bundler";
}

// The files of an upload by kind.
class Export {
 public:
  static Result<Export> of(std::span<const PoseFile> files) {
    Export sorted;
    for (const PoseFile& file : files) {
      const Kind kind = kind_of(file);
      const bool has_points = kind != Kind::metashape && kind != Kind::realitycapture_csv &&
                              kind != Kind::realitycapture_xmp && kind != Kind::other_text;
      if (kind != Kind::other &&
          file.bytes.size() > (has_points ? kMaxPoseFileBytes : kMaxPoseTextBytes))
        return fail(ErrorCode::too_large, "Camera poses too large",
                    base_filename(file.name) +
                        " is too large. Export only the cameras, without points and markers.",
                    "files");
      sorted.files_.emplace_back(kind, &file);
    }
    return sorted;
  }

  bool has(Kind kind) const { return count(kind) > 0; }
  std::ptrdiff_t count(Kind kind) const {
    return std::ranges::count(files_, kind, [](const auto& entry) { return entry.first; });
  }

  // Returns the only file of a kind. `what` names it for users.
  Result<const PoseFile*> only(Kind kind, const std::string& what) {
    if (count(kind) > 1)
      return fail(ErrorCode::invalid, "Several exports",
                  "There are several files " + what + ". Add the files of one export.", "files");
    const auto found =
        std::ranges::find(files_, kind, [](const auto& entry) { return entry.first; });
    if (found == files_.end())
      return fail(ErrorCode::invalid, "File missing",
                  "The file " + what + " is missing. Add it to the other files.", "files");
    const PoseFile* const file = found->second;
    files_.erase(found);
    return file;
  }

  // Removes and returns all files of a kind.
  std::vector<const PoseFile*> all(Kind kind) {
    std::vector<const PoseFile*> taken;
    std::erase_if(files_, [&](const auto& entry) {
      if (entry.first == kind) taken.push_back(entry.second);
      return entry.first == kind;
    });
    return taken;
  }

  // Returns the list of Bundler: the only other text, or the one called list.txt.
  Result<const PoseFile*> list() {
    if (count(Kind::other_text) > 1)
      for (auto& [kind, file] : files_)
        if (kind == Kind::other_text && plain_name(file->name) != "list.txt") kind = Kind::other;
    return only(Kind::other_text, "list.txt of Bundler");
  }

  std::vector<std::string> names_left() const {
    std::vector<std::string> names;
    for (const auto& [kind, file] : files_) names.push_back(base_filename(file->name));
    return names;
  }

 private:
  std::vector<std::pair<Kind, const PoseFile*>> files_;
};

Result<PosedPhotographs> read_format(PoseFormat format, Export& files) {
  switch (format) {
    case PoseFormat::colmap: {
      const bool is_text =
          files.has(Kind::colmap_cameras_text) && files.has(Kind::colmap_images_text);
      const bool is_binary =
          files.has(Kind::colmap_cameras_binary) || files.has(Kind::colmap_images_binary);
      if (is_binary && !is_text) {  // COLMAP's text and binary files of a model are equal
        const auto* const cameras =
            STRATA_TRY(files.only(Kind::colmap_cameras_binary, "cameras.bin of COLMAP"));
        const auto* const images =
            STRATA_TRY(files.only(Kind::colmap_images_binary, "images.bin of COLMAP"));
        return read_colmap_binary(*cameras, *images);
      }
      const auto* const cameras =
          STRATA_TRY(files.only(Kind::colmap_cameras_text, "cameras.txt of COLMAP"));
      const auto* const images =
          STRATA_TRY(files.only(Kind::colmap_images_text, "images.txt of COLMAP"));
      return read_colmap_text(*cameras, *images);
    }
    case PoseFormat::metashape: {
      const auto* const file = STRATA_TRY(files.only(Kind::metashape, "of Metashape"));
      return read_metashape(*file);
    }
    case PoseFormat::realitycapture: {
      if (!files.has(Kind::realitycapture_csv))
        return read_realitycapture_xmp(files.all(Kind::realitycapture_xmp));
      // XMP files of the photographs have the same poses.
      const auto* const file =
          STRATA_TRY(files.only(Kind::realitycapture_csv, "of RealityCapture"));
      return read_realitycapture_csv(*file);
    }
    case PoseFormat::bundler: break;
  }
  const auto* const bundle = STRATA_TRY(files.only(Kind::bundle, "of Bundler"));
  const auto* const list = STRATA_TRY(files.list());
  return read_bundler(*bundle, *list);
}

}  // namespace

Result<PosedPhotographs> read_poses(std::span<const PoseFile> files) {
  Export sorted = STRATA_TRY(Export::of(files));
  std::vector<PoseFormat> formats;
  const auto add = [&](PoseFormat format, std::initializer_list<Kind> kinds) {
    if (std::ranges::any_of(kinds, [&](Kind kind) { return sorted.has(kind); }))
      formats.push_back(format);
  };
  add(PoseFormat::colmap, {Kind::colmap_cameras_text, Kind::colmap_images_text,
                           Kind::colmap_cameras_binary, Kind::colmap_images_binary});
  add(PoseFormat::metashape, {Kind::metashape});
  add(PoseFormat::realitycapture, {Kind::realitycapture_csv});
  add(PoseFormat::bundler, {Kind::bundle});
  // Photographs can have XMP files of other programs.
  if (formats.empty()) add(PoseFormat::realitycapture, {Kind::realitycapture_xmp});
  if (formats.empty())
    return fail(ErrorCode::invalid, "No camera poses",
                "None of the files is an export of cameras that Strata reads. Add the files of "
                "Metashape (cameras.xml), RealityCapture (CSV or XMP), COLMAP (cameras and images) "
                "or Bundler (bundle.out and list.txt).",
                "files");
  if (formats.size() > 1)
    return fail(ErrorCode::invalid, "Several exports",
                "There are exports of " + shown_name(formats[0]) + " and " +
                    shown_name(formats[1]) + ". Add the files of one export.",
                "files");
  PosedPhotographs read = STRATA_TRY(read_format(formats.front(), sorted));
  read.format = formats.front();
  read.unused_files = sorted.names_left();
  if (!read.photographs.empty()) return read;
  if (!read.refused.empty()) {
    Error reason = read.refused.front().reason;
    reason.code = ErrorCode::invalid;
    reason.detail = read.refused.front().name + ": " + reason.detail;
    return tl::unexpected<Error>(std::move(reason));
  }
  return fail(ErrorCode::invalid, "No camera poses",
              "None of the photographs has a pose. Align the photographs with " +
                  shown_name(read.format) + ", and export the cameras again.",
              "files");
}

}  // namespace strata::photo
