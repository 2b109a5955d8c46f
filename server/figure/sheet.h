#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::figure {

// What is on a sheet of paper besides the drawing, as shapes and words; each kind of file draws the
// same. Millimetres from the sheet's top left, y down.

struct Path {
  std::vector<glm::dvec2> points;
  bool closed = true;
  std::optional<Rgba> fill{};
  double stroke_mm = 0;  // 0: none; black
};

enum class Anchor { start, middle, end };

struct Words {
  glm::dvec2 at{0};  // on the base line
  std::string text;  // one line
  double size_mm = 3;
  bool bold = false;
  Anchor anchor = Anchor::start;
  bool halo = false;  // white around it, over a drawing
};

using Item = std::variant<Path, Words>;
struct Group {
  std::string id;  // "legend", for who edits the file
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
