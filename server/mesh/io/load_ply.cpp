#include <algorithm>
#include <array>
#include <utility>

#include "mesh/io/face_builder.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/ply_colors.h"
#include "mesh/io/ply_source.h"
#include "mesh/io/texture_loader.h"

namespace strata::mesh {
namespace {

constexpr std::uint64_t kElementsBetweenReports = 65536;

template <class Source>
class PlyReader {
 public:
  PlyReader(Source source, const PlyHeader& header, const InputFiles& files, Progress& progress,
            std::size_t max_triangles)
      : source_(source),
        header_(header),
        file_bytes_(files.scan().bytes.size()),
        progress_(progress),
        faces_(loaded_.mesh, max_triangles) {
    TextureLoader shelf(files, loaded_.mesh, loaded_.repairs);
    for (const std::string& file : header.texture_files)
      loaded_.mesh.materials.push_back({.name = file, .texture = shelf.of_file(file)});
    faces_.use_material(0);
  }

  Result<LoadedMesh> read() {
    for (const PlyElement& element : header_.elements) {
      // Triangles are created after their vertices, independent of their order in the file.
      const bool of_triangles = element.name == "face" || element.name == "tristrips";
      if (of_triangles && !has_vertices_) put_off_.push_back({&element, source_});
      STRATA_TRY(element.name == "vertex"        ? read_vertices(element)
                 : of_triangles && has_vertices_ ? read_triangles(element)
                                                 : skip_element(element));
    }
    if (!has_vertices_) return refuse_file("The PLY has no element \"vertex\".");
    note(loaded_.repairs, "ignored bytes after the last element", source_.bytes_left_over());
    note(loaded_.repairs, "lines with more values than declared", source_.surplus_elements());
    for (auto& [element, begin] : put_off_) {
      source_ = begin;
      STRATA_TRY(read_triangles(*element));
    }
    face_colors_.spread(loaded_);
    faces_.report(loaded_.repairs);
    return std::move(loaded_);
  }

 private:
  Result<void> read_triangles(const PlyElement& element) {
    return element.name == "face" ? read_faces(element) : read_strips(element);
  }

  Result<void> read_vertices(const PlyElement& element) {
    const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
    if (!x || !y || !z || element.properties[*x].count_type || element.properties[*y].count_type ||
        element.properties[*z].count_type) {
      return refuse_file("The element \"vertex\" has no properties x, y and z.");
    }
    if (element.count >= 0xffffffffu)
      return refuse_file("The file has more than 4 294 967 294 vertices. Split the mesh.");
    const PlyColorProperties colors = find_ply_colors(element);
    const PlyType color_type =
        colors.present() ? element.properties[colors.rgba[0]].type : PlyType::u8;
    const auto [u, v] = find_uv(element);
    const auto normal = normals_of_points(element);
    has_vertices_ = true;
    TriangleMesh& mesh = loaded_.mesh;
    mesh.positions.reserve(element.count);
    if (colors.present()) mesh.vertex_colors.reserve(element.count);
    if (u >= 0) vertex_uvs_.reserve(element.count);
    if (normal) loaded_.point_normals.reserve(element.count);
    RealColorScale real_scale;
    std::vector<double> values(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % kElementsBetweenReports == 0 && !report("Reading vertices"))
        return cancelled_problem();
      for (std::size_t k = 0; k < values.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        const bool read =
            property.count_type ? skip_list(property) : source_.value(property.type, values[k]);
        if (!read) return broken("vertex", i, element.count);
      }
      source_.end_element();
      mesh.positions.emplace_back(values[*x], values[*y], values[*z]);
      if (u >= 0) vertex_uvs_.emplace_back(values[u], values[v]);
      if (normal)
        loaded_.point_normals.emplace_back(values[(*normal)[0]], values[(*normal)[1]],
                                           values[(*normal)[2]]);
      if (!colors.present()) continue;
      double rgba[4] = {0, 0, 0, 255};
      for (int k = 0; k < (colors.alpha() ? 4 : 3); ++k)
        rgba[k] = to_byte_scale(color_type, values[colors.rgba[k]]);
      mesh.vertex_colors.push_back(is_real(color_type)
                                       ? real_scale.pack(rgba, colors.alpha(), mesh.vertex_colors)
                                       : pack_color(rgba[0], rgba[1], rgba[2], rgba[3]));
    }
    return {};
  }

  // Only points need the normals of the file. The normals of a mesh follow from its triangles.
  std::optional<std::array<int, 3>> normals_of_points(const PlyElement& element) const {
    const bool triangles = std::ranges::any_of(header_.elements, [](const PlyElement& each) {
      return (each.name == "face" || each.name == "tristrips") && each.count > 0;
    });
    const auto x = element.find({"nx", "normal_x"}), y = element.find({"ny", "normal_y"}),
               z = element.find({"nz", "normal_z"});
    if (triangles || !x || !y || !z) return std::nullopt;
    for (const int at : {*x, *y, *z})
      if (element.properties[at].count_type) return std::nullopt;
    return std::array{*x, *y, *z};
  }

  static std::pair<int, int> find_uv(const PlyElement& element) {
    static constexpr std::array<std::array<std::string_view, 2>, 4> kNames{
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};
    for (const auto& [first, second] : kNames) {
      const auto u = element.find({first}), v = element.find({second});
      if (u && v && !element.properties[*u].count_type && !element.properties[*v].count_type)
        return {*u, *v};
    }
    return {-1, -1};
  }

  Result<void> read_faces(const PlyElement& element) {
    const auto indices = element.find({"vertex_indices", "vertex_index"});
    if (!indices || !element.properties[*indices].count_type) {
      if (element.count == 0) return {};
      return refuse_file("The element \"face\" has no list \"vertex_indices\".");
    }
    const PlyProperty& index_list = element.properties[*indices];
    // A triangle has at least the bytes of a list with three indices.
    const std::uint64_t least =
        source_.rest() /
        (1 + 3 * (header_.encoding == PlyEncoding::ascii ? 2 : bytes_of(index_list.type)));
    faces_.reserve(std::min(element.count, least));
    const auto texcoords = element.find({"texcoord", "texcoords"});
    const auto texnumber = element.find({"texnumber"});
    const auto colors =
        loaded_.mesh.vertex_colors.empty() ? find_ply_colors(element) : PlyColorProperties{};
    if (colors.present()) face_colors_.begin(loaded_.mesh.positions.size());

    std::vector<FaceBuilder::Corner> corners;
    std::vector<double> values(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % kElementsBetweenReports == 0 && !report("Reading faces")) return cancelled_problem();
      bool has_uv = !vertex_uvs_.empty();
      uv_list_.clear();
      for (std::size_t k = 0; k < values.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (static_cast<int>(k) == *indices) {
          STRATA_TRY(read_indices(property, i, element.count, corners));
        } else if (texcoords && static_cast<int>(k) == *texcoords && property.count_type) {
          if (!read_uv_list(property)) return broken("face", i, element.count);
        } else if (!(property.count_type ? skip_list(property)
                                         : source_.value(property.type, values[k]))) {
          return broken("face", i, element.count);
        }
      }
      source_.end_element();
      if (!uv_list_.empty() && uv_list_.size() == 2 * corners.size()) {
        has_uv = true;
        for (std::size_t k = 0; k < corners.size(); ++k)
          corners[k].uv = {uv_list_[2 * k], uv_list_[2 * k + 1]};
      }
      if (colors.present()) face_colors_.add(element, colors, values, corners);
      if (texnumber && !element.properties[*texnumber].count_type)
        faces_.use_material(material_of(values[*texnumber]));
      STRATA_TRY(faces_.add(corners, has_uv));
    }
    return {};
  }

  static std::uint16_t material_of(double texnumber) {
    return texnumber >= 0 && texnumber < kNoMaterial ? static_cast<std::uint16_t>(texnumber)
                                                     : kNoMaterial;
  }

  Result<void> read_indices(const PlyProperty& list, std::uint64_t face, std::uint64_t faces,
                            std::vector<FaceBuilder::Corner>& corners) {
    corners.clear();
    std::int64_t count = 0, index = 0;
    if (!read_count(list, count)) return broken("face", face, faces);
    if (static_cast<std::uint64_t>(count) > kMaxPolygonCorners) {
      return FaceBuilder::too_many_corners("face " + std::to_string(face) + " (" + source_.place() +
                                           ")");
    }
    for (std::int64_t k = 0; k < count; ++k) {
      if (!source_.integer(list.type, index)) return broken("face", face, faces);
      STRATA_TRY(check_index("Face " + std::to_string(face), index));
      FaceBuilder::Corner corner{static_cast<std::uint32_t>(index)};
      if (!vertex_uvs_.empty()) corner.uv = vertex_uvs_[corner.position];
      corners.push_back(corner);
    }
    return {};
  }

  bool read_uv_list(const PlyProperty& list) {
    std::int64_t count = 0;
    if (!read_count(list, count)) return false;
    // The list is too long for any face, so its coordinates cannot be assigned to corners.
    if (static_cast<std::uint64_t>(count) > 2 * kMaxPolygonCorners) {
      return source_.skip(list.type, static_cast<std::uint64_t>(count));
    }
    for (std::int64_t k = 0; k < count; ++k) {
      double value = 0;
      if (!source_.value(list.type, value)) return false;
      uv_list_.push_back(static_cast<float>(value));
    }
    return true;
  }

  // A negative index ends a strip. Every second triangle of a strip has the opposite winding.
  // Triangles with a repeated corner only connect strips and are not a fault.
  Result<void> read_strips(const PlyElement& element) {
    const auto indices = element.find({"vertex_indices", "vertex_index"});
    if (!indices || !element.properties[*indices].count_type) {
      return refuse_file("The element \"tristrips\" has no list \"vertex_indices\".");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        double ignored = 0;
        if (static_cast<int>(k) == *indices) {
          STRATA_TRY(read_strip_list(property, i, element.count));
        } else if (!(property.count_type ? skip_list(property)
                                         : source_.value(property.type, ignored))) {
          return broken("tristrips", i, element.count);
        }
      }
      source_.end_element();
    }
    return {};
  }

  Result<void> read_strip_list(const PlyProperty& list, std::uint64_t strip, std::uint64_t strips) {
    std::int64_t count = 0, index = 0;
    if (!read_count(list, count)) return broken("tristrips", strip, strips);
    std::array<FaceBuilder::Corner, 3> last;
    std::uint64_t length = 0;
    for (std::int64_t k = 0; k < count; ++k) {
      if (k % std::int64_t{kElementsBetweenReports} == 0 && !report("Reading triangle strips"))
        return cancelled_problem();
      if (!source_.integer(list.type, index)) return broken("tristrips", strip, strips);
      if (index < 0) {
        length = 0;
        continue;
      }
      STRATA_TRY(check_index("Triangle strip " + std::to_string(strip), index));
      FaceBuilder::Corner corner{static_cast<std::uint32_t>(index)};
      if (!vertex_uvs_.empty()) corner.uv = vertex_uvs_[corner.position];
      last = {last[1], last[2], corner};
      if (++length < 3) continue;
      const bool odd = length % 2 == 0;
      if (last[0].position == last[1].position || last[1].position == last[2].position ||
          last[0].position == last[2].position)
        continue;
      auto added =
          faces_.add_triangle(last[odd ? 1 : 0], last[odd ? 0 : 1], last[2], !vertex_uvs_.empty());
      if (!added) return added;
    }
    return {};
  }

  Result<void> skip_element(const PlyElement& element) {
    if (element.properties.empty()) return {};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % kElementsBetweenReports == 0 && !report("Reading " + element.name))
        return cancelled_problem();
      for (const PlyProperty& property : element.properties) {
        if (!(property.count_type ? skip_list(property) : source_.skip(property.type, 1))) {
          return broken(element.name, i, element.count);
        }
      }
      source_.end_element();
    }
    return {};
  }

  bool read_count(const PlyProperty& list, std::int64_t& count) {
    if (!source_.integer(*list.count_type, count)) return false;
    list_too_long_ = count < 0 || !source_.holds(list.type, static_cast<std::uint64_t>(count));
    return !list_too_long_;
  }

  bool skip_list(const PlyProperty& list) {
    std::int64_t count = 0;
    return read_count(list, count) && source_.skip(list.type, static_cast<std::uint64_t>(count));
  }

  Result<void> check_index(const std::string& what, std::int64_t index) const {
    const std::size_t vertices = loaded_.mesh.positions.size();
    if (index >= 0 && static_cast<std::uint64_t>(index) < vertices) return {};
    return refuse_file(what + " (" + source_.place() + ") refers to vertex " +
                       std::to_string(index) + ", but the file has " + std::to_string(vertices) +
                       " vertices (0 … " + std::to_string(static_cast<std::int64_t>(vertices) - 1) +
                       ").");
  }

  tl::unexpected<Error> broken(const std::string& element, std::uint64_t index,
                               std::uint64_t count) {
    const std::string where = element + " " + std::to_string(index) + " of " +
                              std::to_string(count) + " (" + source_.place() + ")";
    if (list_too_long_)
      return refuse_file(
          "The list of " + where +
          " has an invalid length: it is negative, or longer than the file can contain.");
    if (source_.fault() == PlyFault::not_a_number)
      return refuse_file("In " + where + ", the file contains a value that is not a number.");
    return refuse_file("The file ends within " + where +
                       ": the file is incomplete. Export or upload it again.");
  }

  bool report(const std::string& message) {
    progress_.report(kParsedShare * static_cast<double>(source_.offset()) /
                         static_cast<double>(std::max<std::size_t>(file_bytes_, 1)),
                     message);
    return !progress_.cancelled();
  }

  Source source_;
  const PlyHeader& header_;
  std::size_t file_bytes_;
  Progress& progress_;
  LoadedMesh loaded_;
  FaceBuilder faces_;
  bool has_vertices_ = false;
  bool list_too_long_ = false;
  std::vector<glm::vec2> vertex_uvs_;
  std::vector<float> uv_list_;
  PlyFaceColors face_colors_;
  std::vector<std::pair<const PlyElement*, Source>> put_off_;  // with the start of their data
};

}  // namespace

Result<LoadedMesh> parse_ply(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles) {
  const auto bytes = files.scan().bytes;
  const PlyHeader header = STRATA_TRY(parse_ply_header(bytes));
  if (header.encoding == PlyEncoding::ascii) {
    return PlyReader(PlyAsciiSource(bytes, header), header, files, progress, max_triangles).read();
  }
  const PlyBinarySource source(bytes, header.data_offset,
                               header.encoding == PlyEncoding::big_endian);
  return PlyReader(source, header, files, progress, max_triangles).read();
}

}  // namespace strata::mesh
