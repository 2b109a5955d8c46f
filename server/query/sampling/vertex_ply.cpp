#include "query/sampling/vertex_ply.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "domain/layers/texel_lookup.h"
#include "domain/people/question.h"

namespace strata::query {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kPieceBytes = 1u << 18;
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::uint32_t);

const char* ply_type(ValueType type) {
  switch (type) {
    case ValueType::u8: return "uchar";
    case ValueType::i8: return "char";
    case ValueType::u16: return "ushort";
    case ValueType::i16: return "short";
    case ValueType::u32: return "uint";
    case ValueType::i32: return "int";
    default: return "float";
  }
}
std::size_t ply_bytes(ValueType type) {
  return type == ValueType::f16 ? sizeof(float) : static_cast<std::size_t>(bytes_per_texel(type));
}

std::string property_name(const std::string& slug) {
  static constexpr std::string_view kTaken[] = {
      "x",      "y",     "z",      "nx",      "ny",        "nz",         "s",
      "t",      "u",     "v",      "red",     "green",     "blue",       "alpha",
      "radius", "value", "scalar", "quality", "intensity", "confidence", "flags"};
  return std::ranges::find(kTaken, slug) == std::end(kTaken) ? slug : "layer_" + slug;
}

template <class T>
void append(std::vector<std::uint8_t>& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

}  // namespace

VertexPly::VertexPly(std::shared_ptr<const mesh::Geometry> geometry, std::vector<LayerView> layers,
                     std::optional<VertexColors> colors)
    : geometry_(std::move(geometry)), layers_(std::move(layers)), colors_(std::move(colors)) {
  const mesh::Geometry& mesh = *geometry_;
  for (const glm::dvec3& position : mesh.positions)
    has_doubles_ |= glm::dvec3(glm::vec3(position)) != position;
  const auto same_color = [&](const mesh::Vertex& vertex) {
    return vertex.color == mesh.vertices.front().color;
  };
  has_colors_ = colors_ || !std::ranges::all_of(mesh.vertices, same_color);
  first_.assign(mesh.positions.size() + 1, 0);
  for (const mesh::Vertex& vertex : mesh.vertices) ++first_[vertex.position_index + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  vertices_.resize(mesh.vertices.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    vertices_[next[mesh.vertices[i].position_index]++] = i;
}

std::string VertexPly::head() const {
  const char* place = has_doubles_ ? "double" : "float";
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(geometry_->positions.size()) + "\n";
  for (const char* axis : {"x", "y", "z"})
    text += std::string("property ") + place + " " + axis + "\n";
  if (has_colors_)
    for (const char* channel : {"red", "green", "blue"})
      text += std::string("property uchar ") + channel + "\n";
  for (const LayerView& view : layers_) {
    const std::string name = property_name(view.layer.slug);
    text += std::string("property ") + ply_type(view.layer.type) + " " + name +
            "\nproperty uchar " + name + "_valid\n";
  }
  return text + "element face " + std::to_string(geometry_->triangle_count()) +
         "\nproperty list uchar uint vertex_indices\nend_header\n";
}

std::uint64_t VertexPly::bytes() const {
  std::uint64_t of_vertex =
      3 * (has_doubles_ ? sizeof(double) : sizeof(float)) + (has_colors_ ? 3 : 0);
  for (const LayerView& view : layers_) of_vertex += ply_bytes(view.layer.type) + 1;
  return head().size() + of_vertex * geometry_->positions.size() +
         kFaceBytes * geometry_->triangle_count();
}

void VertexPly::append_vertex(std::uint32_t position, std::vector<std::uint8_t>& out) const {
  const mesh::Geometry& mesh = *geometry_;
  const glm::dvec3& place = mesh.positions[position];
  for (int axis = 0; axis < 3; ++axis)
    if (has_doubles_)
      append(out, place[axis]);
    else
      append(out, static_cast<float>(place[axis]));
  const std::span of_position(vertices_.data() + first_[position],
                              vertices_.data() + first_[position + 1]);
  if (colors_) {
    const auto color = colors_->at(of_position);
    out.insert(out.end(), color.begin(), color.end());
  } else if (has_colors_) {
    const std::uint32_t color = of_position.empty() ? 0 : mesh.vertices[of_position.front()].color;
    for (int channel = 0; channel < 3; ++channel)
      out.push_back(static_cast<std::uint8_t>(color >> (8 * channel)));
  }
  for (const LayerView& view : layers_) {
    std::optional<std::uint32_t> bits;
    for (const std::uint32_t vertex : of_position)
      if (!bits)
        bits = bits_at(view.snapshot.tiles, view.layer.resolution, mesh.vertices[vertex].uv);
    if (view.layer.type == ValueType::f16) {
      append(out, static_cast<float>(decode_value(view.layer.type, bits.value_or(0))));
    } else {
      const std::uint32_t value = bits.value_or(0);
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
      out.insert(out.end(), bytes, bytes + ply_bytes(view.layer.type));
    }
    out.push_back(bits.has_value() ? 1 : 0);
  }
}

bool VertexPly::write(const std::function<bool(std::span<const std::uint8_t>)>& sink) const {
  const std::string text = head();
  std::vector<std::uint8_t> out(text.begin(), text.end());
  const auto send_full = [&] {
    if (out.size() < kPieceBytes) return true;
    check_question();
    const bool sent = sink(out);
    out.clear();
    return sent;
  };
  for (std::uint32_t i = 0; i < geometry_->positions.size(); ++i) {
    append_vertex(i, out);
    if (!send_full()) return false;
  }
  for (std::size_t i = 0; i < geometry_->indices.size(); i += 3) {
    out.push_back(3);
    for (std::size_t corner = i; corner < i + 3; ++corner)
      append(out, geometry_->vertices[geometry_->indices[corner]].position_index);
    if (!send_full()) return false;
  }
  return sink(out);
}

}  // namespace strata::query
