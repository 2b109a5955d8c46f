#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "domain/scene/model.h"
#include "mesh/io/input_files.h"

namespace strata::mesh {

// The comments of a mesh file: the `comment` and `obj_info` lines of a PLY, the `#` lines at the
// beginning of an OBJ, the header of a binary STL or the first line of an ASCII one. At most
// kMaxComments, cut to kMaxCommentLength bytes, as UTF-8. glTF has none.
constexpr std::size_t kMaxComments = 200, kMaxCommentLength = 500;
std::vector<std::string> file_comments(const InputFiles& files);

// A unit or an up direction that a comment states, and the comment.
template <class Value>
struct Stated {
  Value value;
  std::string comment;
};

// "unit: mm", "units millimetres", "File units = meters" (Alias, SketchUp), "obj_info units
// millimeter", "UNITS=mm" (headers of STL). The first comment with a unit decides; if it is not one
// of the supported units (inches), the result is empty.
std::optional<Stated<Unit>> stated_unit(std::span<const std::string> comments);

// "up axis: Z", "Y-up", "y_down": one of kUpDirections.
std::optional<Stated<std::string>> stated_up(std::span<const std::string> comments);

}  // namespace strata::mesh
