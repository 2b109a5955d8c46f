#include <map>
#include <optional>

#include "mesh/io/face_builder.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/mtl.h"
#include "mesh/io/obj_lines.h"
#include "mesh/io/plain_text.h"
#include "mesh/io/texture_loader.h"
#include "mesh/texture/vertex_color.h"

namespace strata::mesh {
namespace {

constexpr std::uint64_t kLinesBetweenReports = 65536;
constexpr std::size_t kMaxNumbers = 8;
constexpr std::size_t kMaxLibraries = 100, kMaxNames = 10000;
constexpr int kTextureToFind = 0;  // of a UDIM material whose tiles are not known yet

// Reads counts, points and faces in three passes. A face can therefore use points that follow it in
// the file, and polygons can be split while they are read.
class ObjReader {
 public:
  ObjReader(const InputFiles& files, Progress& progress, std::size_t max_triangles)
      : files_(files),
        text_(files.scan().bytes),
        bytes_(text_.bytes()),
        progress_(progress),
        faces_(loaded_.mesh, max_triangles),
        shelf_(files, loaded_.mesh, loaded_.repairs) {}

  Result<LoadedMesh> read() {
    STRATA_TRY(count_lines());
    read_materials();
    STRATA_TRY(read_points());
    STRATA_TRY(read_faces());
    if (colored_ > 0)
      note(loaded_.repairs, "vertices without colour", loaded_.mesh.positions.size() - colored_);
    faces_.report(loaded_.repairs);
    note(loaded_.repairs, "faces that refer to texture coordinates missing from the file",
         without_named_uv_);
    note(loaded_.repairs, "faces that refer to normals missing from the file",
         without_named_normal_);
    note(loaded_.repairs, "materials without a definition", undefined_.size());
    UdimTiles::resolve(shelf_, references_, loaded_.mesh);
    note(loaded_.repairs, "ignored lines, points, curves and free-form surfaces", ignored_);
    return std::move(loaded_);
  }

 private:
  // Reserves memory for the arrays, because growth by doubling could exceed the memory limit.
  Result<void> count_lines() {
    ObjLines lines(bytes_);
    std::string_view line;
    std::uint64_t positions = 0, uvs = 0, faces = 0;
    for (std::uint64_t n = 0; lines.next(line); ++n) {
      if (n % kLinesBetweenReports == 0 && !report(0, 0.1 * lines.fraction()))
        return cancelled_problem();
      const std::string_view keyword = next_word(line);
      positions += keyword == "v";
      uvs += keyword == "vt";
      normals_ += keyword == "vn";
      faces += keyword == "f";
      if (keyword == "mtllib" && libraries_.size() < kMaxLibraries)
        libraries_.emplace_back(rest_of(line));
    }
    if (positions >= 0xffffffffu || uvs >= 0xffffffffu)
      return refuse_file("The file has more than 4 294 967 294 vertices. Split the mesh.");
    if (faces == 0 && positions == 0)
      return refuse_file(
          "The OBJ has neither vertices nor faces: it is empty, or it is not an OBJ file.");
    // Lines shorter than "v 0 0 0", "vt 0" and "f 1 2 3" are refused or have no effect.
    loaded_.mesh.positions.reserve(std::min<std::uint64_t>(positions, bytes_.size() / 8 + 1));
    uvs_.reserve(std::min<std::uint64_t>(uvs, bytes_.size() / 5 + 1));
    faces_.reserve(std::min<std::uint64_t>(faces, bytes_.size() / 8 + 1));
    return {};
  }

  static std::string_view rest_of(std::string_view line) {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    return line;
  }

  // The name of a material library may contain blanks, and one line may name several libraries. If
  // no library is named, the only uploaded .mtl file is used.
  std::vector<const InputFiles::Entry*> find_libraries() {
    std::vector<const InputFiles::Entry*> found;
    for (const std::string& library : libraries_) {
      if (const auto* whole = files_.find(library)) {
        found.push_back(whole);
        continue;
      }
      std::string_view words = library;
      for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
        if (const auto* entry = files_.find(word))
          found.push_back(entry);
        else
          note(loaded_.repairs, "materials not among the files: " + printable(word), 1);
      }
    }
    if (!libraries_.empty()) return found;
    for (const auto* entry : files_.own())
      if (entry->name.ends_with(".mtl") || entry->name.ends_with(".MTL")) found.push_back(entry);
    if (found.size() > 1) found.clear();
    return found;
  }

  void read_materials() {
    for (const InputFiles::Entry* library : find_libraries()) {
      for (MtlMaterial& mtl :
           parse_mtl(library->bytes, kNoMaterial - loaded_.mesh.materials.size())) {
        const auto index = static_cast<std::uint16_t>(loaded_.mesh.materials.size());
        if (!material_of_name_.emplace(mtl.name, index).second) continue;
        Material material{.name = printable(mtl.name), .color = mtl.color};
        if (mtl.clamp) material.wrap_u = material.wrap_v = Wrap::clamp;
        if (!mtl.texture.empty()) {
          material.color = glm::vec4(1);  // Kd is often not meaningful together with an image
          material.texture =
              UdimTiles::is_pattern(mtl.texture) ? kTextureToFind : shelf_.of_file(mtl.texture);
        }
        loaded_.mesh.materials.push_back(std::move(material));
        references_.push_back(mtl.texture);
        uv_transforms_.push_back({mtl.uv_scale, mtl.uv_offset});
      }
    }
  }

  void use_material(std::string_view name) {
    const auto found = material_of_name_.find(name);
    uv_transform_ =
        found == material_of_name_.end() ? UvTransform{} : uv_transforms_[found->second];
    faces_.use_material(found == material_of_name_.end() ? kNoMaterial : found->second);
    if (found == material_of_name_.end() && undefined_.size() < kMaxNames)
      undefined_.emplace(name, 0);
  }

  Result<void> read_points() {
    ObjLines lines(bytes_);
    std::string_view line;
    for (std::uint64_t n = 0; lines.next(line); ++n) {
      if (n % kLinesBetweenReports == 0 && !report(0.1, 0.5 * lines.fraction()))
        return cancelled_problem();
      const std::string_view keyword = next_word(line);
      if (keyword != "v" && keyword != "vt") continue;
      if (!read_numbers(line))
        return fault(lines, "\"" + std::string(keyword) +
                                "\" is followed by something that is not a number");
      if (keyword == "vt") {
        if (count_ < 1) return fault(lines, "\"vt\" needs a number");
        uvs_.emplace_back(numbers_[0], count_ > 1 ? numbers_[1] : 0.0);
        continue;
      }
      if (count_ < 3) return fault(lines, "\"v\" needs three numbers");
      loaded_.mesh.positions.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
      add_color();
    }
    return {};
  }

  // x y z | x y z w | x y z r g b | x y z r g b a
  void add_color() {
    std::vector<std::uint32_t>& colors = loaded_.mesh.vertex_colors;
    const std::size_t index = loaded_.mesh.positions.size() - 1;
    if (count_ < 6) {
      if (!colors.empty()) colors.push_back(0xffffffffu);
      return;
    }
    if (colors.empty()) {
      colors.reserve(loaded_.mesh.positions.capacity());
      colors.resize(index, 0xffffffffu);
    }
    const double rgba[4] = {numbers_[3], numbers_[4], numbers_[5], 1.0};
    colors.push_back(color_scale_.pack(rgba, false, colors));
    ++colored_;
  }

  Result<void> read_faces() {
    ObjLines lines(bytes_);
    std::string_view line;
    std::vector<FaceBuilder::Corner> corners;
    for (std::uint64_t n = 0; lines.next(line); ++n) {
      if (n % kLinesBetweenReports == 0 && !report(0.6, 0.4 * lines.fraction()))
        return cancelled_problem();
      const std::string_view keyword = next_word(line);
      if (keyword == "v") {
        ++positions_so_far_;
      } else if (keyword == "vt") {
        ++uvs_so_far_;
      } else if (keyword == "vn") {
        ++normals_so_far_;
      } else if (keyword == "f") {
        corners.clear();
        bool has_uv = true;
        missing_uv_ = missing_normal_ = false;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
          if (corners.size() == kMaxPolygonCorners) {
            return FaceBuilder::too_many_corners("line " + std::to_string(lines.line_number()));
          }
          if (auto corner = read_corner(lines, word, has_uv); corner) {
            corners.push_back(*corner);
          } else {
            return tl::unexpected(corner.error());
          }
        }
        without_named_uv_ += missing_uv_;
        without_named_normal_ += missing_normal_;
        STRATA_TRY(faces_.add(corners, has_uv));
      } else if (keyword == "usemtl") {
        use_material(rest_of(line));
      } else if (keyword == "l" || keyword == "p" || keyword == "curv" || keyword == "curv2" ||
                 keyword == "surf") {
        ++ignored_;
      }
    }
    return {};
  }

  // Reads v, v/vt, v//vn or v/vt/vn. The numbers count from 1, or backwards from the last element
  // before the face. If texture coordinates or normals are missing, the face is read as if it did
  // not refer to them. Some writers always write these numbers.
  Result<FaceBuilder::Corner> read_corner(const ObjLines& lines, std::string_view word,
                                          bool& has_uv) {
    const std::size_t slash = word.find('/');
    FaceBuilder::Corner corner;
    std::int64_t index = 0;
    if (!parse_integer(word.substr(0, slash), index))
      return fault(lines, "\"" + printable(word) + "\" is not a corner of a face");
    const auto position = resolve(index, positions_so_far_, loaded_.mesh.positions.size());
    if (!position) {
      return fault(
          lines,
          "the face refers to vertex " + std::to_string(index) + ", but the file has " +
              std::to_string(loaded_.mesh.positions.size()) + " vertices" +
              (index < 0 ? " (" + std::to_string(positions_so_far_) + " above this line)" : ""));
    }
    corner.position = static_cast<std::uint32_t>(*position);
    std::string_view uv_word, normal_word;
    if (slash != std::string_view::npos) {
      uv_word = word.substr(slash + 1);
      const std::size_t second = uv_word.find('/');
      if (second != std::string_view::npos) normal_word = uv_word.substr(second + 1);
      uv_word = uv_word.substr(0, second);
    }
    // Normals are not used, so they are not checked further.
    if (!normal_word.empty() &&
        !(parse_integer(normal_word, index) && resolve(index, normals_so_far_, normals_)))
      missing_normal_ = true;
    if (uv_word.empty()) {
      has_uv = false;
      return corner;
    }
    if (!parse_integer(uv_word, index))
      return fault(lines, "\"" + printable(word) + "\" is not a corner of a face");
    const auto uv = resolve(index, uvs_so_far_, uvs_.size());
    if (!uv) {
      has_uv = false;
      missing_uv_ = true;
      return corner;
    }
    corner.uv = uvs_[*uv] * uv_transform_.scale + uv_transform_.offset;
    return corner;
  }

  static std::optional<std::uint64_t> resolve(std::int64_t index, std::uint64_t so_far,
                                              std::uint64_t count) {
    if (index > 0 && static_cast<std::uint64_t>(index) <= count)
      return static_cast<std::uint64_t>(index) - 1;
    if (index < 0 && index >= -static_cast<std::int64_t>(so_far))
      return so_far - static_cast<std::uint64_t>(-index);
    return std::nullopt;
  }

  bool read_numbers(std::string_view line) {
    count_ = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      double value = 0;
      if (!parse_number(word, value)) return false;
      if (count_ < kMaxNumbers) numbers_[count_++] = value;
    }
    return true;
  }

  static std::string printable(std::string_view word) {
    std::string result;
    for (char c : word.substr(0, 100)) result += c >= ' ' && c < 127 ? c : '?';
    return result;
  }
  static tl::unexpected<Error> fault(const ObjLines& lines, const std::string& what) {
    return refuse_file("Line " + std::to_string(lines.line_number()) + ": " + what + ".");
  }

  bool report(double done, double share) {
    progress_.report(kParsedShare * (done + share),
                     done < 0.6 ? "Reading vertices" : "Reading faces");
    return !progress_.cancelled();
  }

  const InputFiles& files_;
  const PlainText text_;
  const std::span<const std::uint8_t> bytes_;
  Progress& progress_;
  LoadedMesh loaded_;
  FaceBuilder faces_;
  std::vector<glm::vec2> uvs_;
  RealColorScale color_scale_;
  double numbers_[kMaxNumbers] = {};
  std::size_t count_ = 0;
  std::uint64_t positions_so_far_ = 0;
  std::uint64_t uvs_so_far_ = 0;
  std::uint64_t normals_ = 0, normals_so_far_ = 0;
  std::uint64_t without_named_uv_ = 0, without_named_normal_ = 0;
  bool missing_uv_ = false, missing_normal_ = false;  // for the current face
  std::uint64_t colored_ = 0;
  std::uint64_t ignored_ = 0;

  struct UvTransform {
    glm::vec2 scale{1}, offset{0};
  };
  TextureLoader shelf_;
  std::vector<std::string> libraries_;
  std::map<std::string, std::uint16_t, std::less<>> material_of_name_, undefined_;
  std::vector<std::string> references_;  // image of each material, as named in the MTL
  std::vector<UvTransform> uv_transforms_;
  UvTransform uv_transform_;
};

}  // namespace

Result<LoadedMesh> parse_obj(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles) {
  return ObjReader(files, progress, max_triangles).read();
}

}  // namespace strata::mesh
