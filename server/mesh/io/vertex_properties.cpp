#include "mesh/io/vertex_properties.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>
#include <unordered_map>

#include "mesh/io/load_formats.h"
#include "mesh/io/plain_text.h"
#include "mesh/io/ply_source.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {
namespace {

// The properties with a defined meaning for a mesh.
constexpr std::array<std::string_view, 24> kKnown{"x",
                                                  "y",
                                                  "z",
                                                  "nx",
                                                  "ny",
                                                  "nz",
                                                  "red",
                                                  "green",
                                                  "blue",
                                                  "alpha",
                                                  "diffuse_red",
                                                  "diffuse_green",
                                                  "diffuse_blue",
                                                  "r",
                                                  "g",
                                                  "b",
                                                  "a",
                                                  "s",
                                                  "t",
                                                  "u",
                                                  "v",
                                                  "texture_u",
                                                  "texture_v",
                                                  "flags"};

struct PlaceHash {
  std::size_t operator()(const glm::dvec3& p) const {
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k)
      h = (h ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0x9e3779b97f4a7c15ULL;
    return h ^ h >> 29;
  }
};

template <class Source>
bool skip_list(Source& source, const PlyProperty& property) {
  std::int64_t count = 0;
  return source.integer(*property.count_type, count) && count >= 0 &&
         source.skip(property.type, static_cast<std::uint64_t>(count));
}

template <class Source>
Result<VertexProperty> read(Source source, const PlyHeader& header, const std::string& name) {
  const auto broken = [&](const PlyElement& element, std::uint64_t i) {
    return refuse_file("The file ends or cannot be read at " + source.place() + ", in " +
                       element.name + " " + std::to_string(i + 1) + " of " +
                       std::to_string(element.count) + ".");
  };
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"}),
               at = element.find({name});
    const auto is_number = [&](const std::optional<int>& k) {
      return k && !element.properties[*k].count_type;
    };
    if (is_vertex && !(is_number(x) && is_number(y) && is_number(z)))
      return refuse_file("The element \"vertex\" has no properties x, y and z.");
    if (is_vertex && !is_number(at))
      return fail(ErrorCode::invalid, "Property not found",
                  "The vertices of the file have no numeric property \"" + name + "\".",
                  "compute.property");
    VertexProperty found;
    std::vector<double> values(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t k = 0; k < values.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        const bool good = property.count_type ? skip_list(source, property)
                                              : source.value(property.type, values[k]);
        if (!good) return broken(element, i);
      }
      if (!values.empty()) source.end_element();
      if (!is_vertex) continue;
      found.positions.emplace_back(values[*x], values[*y], values[*z]);
      found.values.push_back(values[*at]);
    }
    if (is_vertex) return found;
  }
  return refuse_file("The PLY has no element \"vertex\".");
}

}  // namespace

std::vector<std::string> vertex_property_names(std::span<const std::uint8_t> beginning) {
  const auto plain = beginning.subspan(utf8_mark(beginning));
  std::string lines(plain.begin(), plain.end());
  std::replace(lines.begin(), lines.end(), '\r', '\n');  // lines may end with a single CR
  std::istringstream text(std::move(lines));
  std::string line;
  if (!std::getline(text, line) || !line.starts_with("ply")) return {};
  std::vector<std::string> names;
  bool in_vertex = false;
  while (std::getline(text, line) && !line.starts_with("end_header")) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "element") in_vertex = type == "vertex";
    if (word != "property" || !in_vertex || type == "list" || name.empty()) continue;
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) names.push_back(name);
  }
  return names;
}

Result<VertexProperty> read_vertex_property(std::span<const std::uint8_t> file,
                                            const std::string& property) {
  const auto header = STRATA_TRY(parse_ply_header(file));
  if (header.encoding == PlyEncoding::ascii)
    return read(PlyAsciiSource(file, header), header, property);
  return read(PlyBinarySource(file, header.data_offset, header.encoding == PlyEncoding::big_endian),
              header, property);
}

Result<VertexProperty> read_vertex_csv(std::span<const std::uint8_t> scan,
                                       const std::string& filename, std::string_view csv,
                                       Progress& progress) {
  const InputKind kind = input_kind(filename);
  if (kind != InputKind::ply && kind != InputKind::obj)
    return fail(ErrorCode::invalid, "Order of vertices unknown",
                "Only PLY and OBJ files store the order of the vertices. Choose such a file.",
                "source");
  std::vector<InputFiles::Entry> entries;
  entries.push_back({filename, scan, std::nullopt});
  const auto files = STRATA_TRY(InputFiles::of(std::move(entries), {}, progress));
  auto mesh =
      STRATA_TRY(kind == InputKind::ply ? parse_ply(files, progress) : parse_obj(files, progress));
  VertexProperty property{std::move(mesh.mesh.positions), {}};
  property.values.reserve(property.positions.size());
  const auto refuse = [](std::size_t line, const std::string& what) {
    return fail(ErrorCode::invalid, "Invalid CSV", "Line " + std::to_string(line) + ": " + what,
                "body");
  };
  std::size_t line = 0;
  while (!csv.empty()) {
    ++line;
    const std::size_t end = csv.find('\n');
    std::string_view text = csv.substr(0, end);
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!text.empty() && text != "nan" && text != "NaN" &&
        (!parse_number(text, value) || !std::isfinite(value))) {
      if (line == 1) continue;
      return refuse(line, "\"" + std::string(text.substr(0, 40)) +
                              "\" is not a number. Send one value per line.");
    }
    if (property.values.size() == property.positions.size()) {
      if (text.empty()) continue;  // blank lines at the end
      return refuse(
          line, "the scan has only " + std::to_string(property.positions.size()) + " vertices.");
    }
    property.values.push_back(value);
  }
  if (property.values.size() != property.positions.size())
    return fail(ErrorCode::invalid, "Invalid CSV",
                "There are values for " + std::to_string(property.values.size()) +
                    " of the scan's " + std::to_string(property.positions.size()) +
                    " vertices. Send one line for each vertex.",
                "body");
  return property;
}

std::vector<double> values_at_positions(const Geometry& geometry, const VertexProperty& property,
                                        bool is_key) {
  struct Sum {
    double sum = 0;
    int count = 0;
  };
  std::unordered_map<glm::dvec3, Sum, PlaceHash> sums;
  sums.reserve(property.positions.size());
  for (std::size_t i = 0; i < property.positions.size(); ++i) {
    if (!std::isfinite(property.values[i])) continue;
    Sum& sum = sums[property.positions[i]];
    if (is_key && sum.count > 0) continue;
    sum.sum += property.values[i];
    ++sum.count;
  }
  std::vector<double> values(geometry.positions.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto found = sums.find(geometry.positions[i]);
    if (found != sums.end()) values[i] = found->second.sum / found->second.count;
  }
  return values;
}

double value_in_triangle(const Geometry& geometry, const std::vector<double>& of_positions,
                         std::uint32_t triangle, const glm::vec3& weights, bool is_key) {
  double sum = 0, weight = 0, nearest = std::numeric_limits<double>::quiet_NaN();
  float largest = -1;
  for (int k = 0; k < 3; ++k) {
    const double value =
        of_positions[geometry.vertices[geometry.indices[3 * std::size_t{triangle} + k]]
                         .position_index];
    if (std::isnan(value)) continue;
    sum += weights[k] * value;
    weight += weights[k];
    if (weights[k] > largest) {
      largest = weights[k];
      nearest = value;
    }
  }
  return is_key || weight < 1e-6 ? nearest : sum / weight;
}

}  // namespace strata::mesh
