#include "mesh/io/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/text/ascii.h"
#include "mesh/io/obj_lines.h"
#include "mesh/io/plain_text.h"

namespace strata::mesh {
namespace {

// Removes up to `most` numbers from the front of `line` and returns their count.
int take_numbers(std::string_view& line, std::array<double, 3>& numbers, int most) {
  int count = 0;
  while (count < most) {
    std::string_view rest = line;
    if (!parse_number(next_word(rest), numbers[count]) || !std::isfinite(numbers[count])) break;
    line = rest;
    ++count;
  }
  return count;
}

void take_pair(std::string_view& line, glm::vec2& pair) {
  std::array<double, 3> numbers{};
  const int count = take_numbers(line, numbers, 3);
  if (count > 0) pair.x = static_cast<float>(numbers[0]);
  if (count > 1) pair.y = static_cast<float>(numbers[1]);
}

// Reads map_Kd [options] file name. The name is the rest of the line after the last option and may
// contain blanks.
void read_map(std::string_view line, MtlMaterial& material) {
  static constexpr std::pair<std::string_view, int> kOptions[] = {
      {"-blendu", 1}, {"-blendv", 1},  {"-boost", 1}, {"-mm", 2}, {"-texres", 1},
      {"-bm", 1},     {"-imfchan", 1}, {"-type", 1},  {"-cc", 1}, {"-clamp", 1}};
  for (;;) {
    line = trimmed(line);
    std::string_view rest = line;
    const std::string_view word = next_word(rest);
    if (word == "-s") {
      take_pair(rest, material.uv_scale);
    } else if (word == "-o") {
      take_pair(rest, material.uv_offset);
    } else if (word == "-t") {
      glm::vec2 turbulence;
      take_pair(rest, turbulence);
    } else {
      const auto* option = std::find_if(std::begin(kOptions), std::end(kOptions),
                                        [&](const auto& known) { return known.first == word; });
      if (option == std::end(kOptions)) break;
      for (int i = 0; i < option->second; ++i) {
        const std::string_view value = next_word(rest);
        if (word == "-clamp") material.clamp = value == "on";
      }
    }
    line = rest;
  }
  if (!line.empty()) material.texture = line;
}

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::size_t most) {
  std::vector<MtlMaterial> materials;
  const PlainText text(bytes);
  ObjLines lines(text.bytes());
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view keyword = next_word(line);
    if (keyword == "newmtl") {
      if (materials.size() == most) break;
      materials.emplace_back().name = trimmed(line);
    }
    if (materials.empty()) continue;
    MtlMaterial& material = materials.back();
    std::array<double, 3> numbers{};
    if (keyword == "Kd") {
      // "Kd spectral …" and "Kd xyz …" do not have three numbers and are skipped.
      const int count = take_numbers(line, numbers, 3);
      if (count == 1) numbers[1] = numbers[2] = numbers[0];
      for (int k = 0; count > 0 && k < 3; ++k)
        material.color[k] = static_cast<float>(std::clamp(numbers[k], 0.0, 1.0));
    } else if (keyword == "d") {
      if (take_numbers(line, numbers, 1) == 1)
        material.color.a = static_cast<float>(std::clamp(numbers[0], 0.0, 1.0));
    } else if (keyword == "Tr") {
      if (take_numbers(line, numbers, 1) == 1)
        material.color.a = static_cast<float>(1 - std::clamp(numbers[0], 0.0, 1.0));
    } else if (keyword == "map_Kd") {
      read_map(line, material);
    }
  }
  return materials;
}

}  // namespace strata::mesh
