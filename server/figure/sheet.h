#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::figure {

// Everything on a sheet of paper except the drawing, as shapes and text; each kind of file draws
// the same. Millimeters from the sheet's top left, y down.

struct Path {
  std::vector<glm::dvec2> points;
  bool closed = true;
  std::optional<Rgba> fill{};
  double stroke_mm = 0;  // 0: no stroke; black
};

enum class Anchor { start, middle, end };

struct Words {
  glm::dvec2 at{0};  // on the baseline
  std::string text;  // one line
  double size_mm = 3;
  bool bold = false;
  Anchor anchor = Anchor::start;
  bool halo = false;  // white border, over a drawing
};

using Item = std::variant<Path, Words>;
struct Group {
  std::string id;  // "legend", for people who edit the file
  std::vector<Item> items;
};

struct Box {
  glm::dvec2 corner{0}, size{0};
};

struct Sheet {
  glm::dvec2 size{0};
  Box drawing;
  std::vector<Group> groups;  // over the drawing, in this order
};

}  // namespace strata::figure
