#include "mesh/io/write_obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <system_error>
#include <vector>

#include "core/text/printable.h"
#include "core/version.h"
#include "core/zip_file.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kLinesAtOnce = 4096;
constexpr double kPrecision = 1e-9;  // of the model's extent
constexpr int kNormalDecimals = 4;   // normals have 10 bits
constexpr int kUvDecimals = 8;       // coordinates are 32-bit floats below 1

// Appends a number without an exponent, as all programs can read it.
void put_number(std::string& text, double value, int decimals) {
  std::array<char, 400> digits;                   // enough for the largest double
  const double shown = value == 0 ? 0.0 : value;  // no -0
  const auto end =
      std::to_chars(digits.begin(), digits.end(), shown, std::chars_format::fixed, decimals).ptr;
  text.append(digits.begin(), end);
}

void put_numbers(std::string& text, const char* keyword, const auto& numbers, int decimals) {
  text += keyword;
  for (int axis = 0; axis < numbers.length(); ++axis) {
    text += ' ';
    put_number(text, numbers[axis], decimals);
  }
  text += '\n';
}

// A comment has one line. The quotation mark at its end is not a backslash, which would continue
// the line.
void put_comment(std::string& text, const char* label, const std::string& value) {
  if (value.empty()) return;
  std::string line = printable(value);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\t'; }, ' ');
  text += std::string("# ") + label + ": \"" + line + "\"\n";
}

// The text of an OBJ file, in pieces of some lines.
class ObjText {
 public:
  ObjText(const SceneModel& model, const std::string& name, Progress& progress)
      : model_(model),
        geometry_(*model.geometry),
        name_(name),
        progress_(progress),
        axes_(scene_axes(model)) {
    const glm::dvec3 extent = glm::dvec3(geometry_.box_max) - glm::dvec3(geometry_.box_min);
    const double largest = std::max({extent.x, extent.y, extent.z}) * model.metres_per_unit;
    if (largest > 0)
      decimals_ = std::clamp(static_cast<int>(std::ceil(-std::log10(largest * kPrecision))), 0, 15);
    const std::size_t vertices = geometry_.vertices.size();
    parts_ = {{1, [this](std::string& text, std::size_t) { put_head(text); }},
              {geometry_.positions.size(),
               [this](std::string& text, std::size_t i) {
                 put_numbers(text, "v", in_scene(geometry_.positions[i]), decimals_);
               }},
              {vertices,
               [this](std::string& text, std::size_t i) {
                 put_numbers(text, "vt", geometry_.vertices[i].uv, kUvDecimals);
               }},
              {vertices,
               [this](std::string& text, std::size_t i) {
                 put_numbers(text, "vn", rotated(glm::dvec3(normal_of(geometry_.vertices[i]))),
                             kNormalDecimals);
               }},
              {1, [this](std::string& text, std::size_t) { text += "usemtl " + name_ + "\n"; }},
              {geometry_.triangle_count(),
               [this](std::string& text, std::size_t i) { put_face(text, i); }}};
    for (const Part& part : parts_) lines_ += part.lines;
  }

  bool operator()(std::string& text) {
    while (part_ < parts_.size() && line_ == parts_[part_].lines) {
      ++part_;
      line_ = 0;
    }
    if (part_ == parts_.size()) return false;
    progress_.report(static_cast<double>(written_) / static_cast<double>(lines_),
                     "Writing the file");
    const std::size_t end = std::min(parts_[part_].lines, line_ + kLinesAtOnce);
    written_ += end - line_;
    for (; line_ < end; ++line_) parts_[part_].put(text, line_);
    return true;
  }

 private:
  struct Part {
    std::size_t lines;
    std::function<void(std::string& text, std::size_t line)> put;
  };

  glm::dvec3 rotated(const glm::dvec3& direction) const {
    return {glm::dot(axes_[0], direction), glm::dot(axes_[1], direction),
            glm::dot(axes_[2], direction)};
  }
  glm::dvec3 in_scene(const glm::dvec3& world) const {
    return rotated(world) * model_.metres_per_unit;
  }

  void put_head(std::string& text) const {
    text += "# Strata " + std::string(version()) + "\n";
    put_comment(text, "model", model_.name);
    put_comment(text, "credit", model_.copyright);
    text += "# meters, +y is up, the front faces +z\n";
    put_numbers(text, "# center of the model:", in_scene(geometry_.origin), decimals_);
    text += "mtllib " + name_ + ".mtl\no " + name_ + "\n";
  }

  void put_face(std::string& text, std::size_t triangle) const {
    text += 'f';
    for (std::size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
      const std::uint32_t vertex = geometry_.indices[corner];
      const std::string number = std::to_string(vertex + std::size_t{1});
      text += ' ' + std::to_string(geometry_.vertices[vertex].position_index + std::size_t{1}) +
              '/' + number + '/' + number;
    }
    text += '\n';
  }

  const SceneModel& model_;
  const Geometry& geometry_;
  const std::string& name_;
  Progress& progress_;
  const std::array<glm::dvec3, 3> axes_;
  int decimals_ = 6;  // of positions
  std::vector<Part> parts_;
  std::size_t lines_ = 0;                          // of all parts
  std::size_t part_ = 0, line_ = 0, written_ = 0;  // so far
};

std::string material_text(const SceneModel& model, const std::string& name,
                          const std::string& texture) {
  return "newmtl " + name + "\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nd 1\nillum " +
         (model.unlit ? "0" : "1") + "\nmap_Kd " + texture + "\n";
}

}  // namespace

Result<std::uint64_t> write_obj(const SceneModel& model, const std::string& name,
                                const std::filesystem::path& file, Progress& progress) {
  progress.report(0, "Writing the file");
  const std::string texture = name + (model.color.media_type == "image/png" ? ".png" : ".jpg");
  const std::string material = material_text(model, name, texture);
  const std::vector<ZipEntry> entries{
      {.name = name + ".obj",
       .content = [&]() -> NextPiece {
         // The parts of the text refer to it, so copies of the function share it.
         return [text = std::make_shared<ObjText>(model, name, progress)](std::string& piece) {
           return (*text)(piece);
         };
       }},
      {.name = name + ".mtl",
       .content =
           std::span(reinterpret_cast<const std::uint8_t*>(material.data()), material.size())},
      {.name = texture, .content = std::span(model.color.bytes), .deflates = false}};
  STRATA_TRY(write_zip(entries, file, progress));
  progress.report(1, "Writing the file");
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file, error);
  if (error)
    return fail(ErrorCode::storage_full, "Model not written",
                "The server cannot read the file that it has written. Try again.");
  return bytes;
}

}  // namespace strata::mesh
