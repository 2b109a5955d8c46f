#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::figure {

// The content of a sheet except the drawing, as shapes and text. It is the same in all file
// formats. Coordinates are millimeters from the sheet's top left, y down.

struct Path {
  std::vector<glm::dvec2> points;
  bool closed = true;
  std::optional<Rgba> fill{};
  double stroke_mm = 0;  // width of the black outline; 0: no outline
};

enum class Anchor { start, middle, end };

struct Words {
  glm::dvec2 at{0};  // a point on the baseline
  std::string text;  // a single line
  double size_mm = 3;
  bool bold = false;
  Anchor anchor = Anchor::start;
  bool halo = false;  // white border for text over a drawing
  double angle = 0;   // around `at`, in degrees counterclockwise
};

// All areas of one class or record. A point is inside if it is inside an odd number of rings.
struct Area {
  std::vector<std::vector<glm::dvec2>> rings;
  Rgba color{};
  Pattern pattern = Pattern::solid;
  double angle = 45;      // of the lines, in degrees
  double spacing_mm = 1;  // of lines and dots
};

// A line or, with one point, a point of a record. A white casing separates it from the drawing.
struct Mark {
  std::vector<glm::dvec2> points;
  Rgba color{};
  double width_mm = 0.5, casing_mm = 0;
};

using Item = std::variant<Path, Words>;
struct Box {
  glm::dvec2 corner{0}, size{0};
};

// Returns the outline of a box.
inline Path outline_of(const Box& box, double stroke_mm = 0) {
  const glm::dvec2 end = box.corner + box.size;
  return {{box.corner, {end.x, box.corner.y}, end, {box.corner.x, end.y}}, true, {}, stroke_mm};
}

struct Group {
  std::string id;  // "legend", for users who edit the file
  std::vector<Item> items;
  std::string name{};  // "Damage", for users who edit the file. May be empty.
  double opacity = 1;
  std::optional<Box> clip{};  // only the part in this box is visible
  // Drawn after the items, in this order.
  std::vector<Area> areas{};
  std::vector<Mark> marks{};
  std::vector<Group> parts{};
};

struct Sheet {
  glm::dvec2 size{0};
  Box drawing;                // of the picture, which contains all views
  std::vector<Group> groups;  // drawn over the drawing, in this order
};

}  // namespace strata::figure
